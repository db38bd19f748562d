// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/tracker.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "geometry/se3.hpp"

namespace photonav {

class Tracker::MapAligner {
  public:
    MapAligner(std::shared_ptr<const ViewSource> map, const Camera& camera,
               const TrackerOptions& options)
        : map_(std::move(map)) {
        if (options.depth) measured_.emplace(map_, *options.depth);
        const ViewSource& views = measured_ ? *measured_ : *map_;
        if (options.searchPrior) {
            wide_.emplace(views, camera, options.map);
        } else {
            dense_.emplace(views, camera, options.map);
        }
    }

    Alignment align(const ImageF& image, const UncertainPose& prior) {
        return wide_ ? wide_->align(image, prior) : dense_->align(image, prior);
    }

    const ViewSource& map() const { return *map_; }
    MeasuredSurfaces* measured() { return measured_ ? &*measured_ : nullptr; }

  private:
    std::shared_ptr<const ViewSource> map_;
    std::optional<MeasuredSurfaces> measured_;  ///< views of the map without what is contradicted
    std::optional<WideAligner> wide_;
    std::optional<DenseAligner> dense_;
};

Tracker::Tracker(std::shared_ptr<const ViewSource> map, const Camera& camera,
                 const UncertainPose& start, const TrackerOptions& options)
    : camera_(camera),
      options_(options),
      odometry_(options.T_b_c),
      velocity_(options.motion),
      loss_(options.loss),
      belief_(start),
      T_certain_w_(start.mean),
      trackedCovariance_(start.covariance) {
    if (!map && !options.keyframes) {
        throw std::invalid_argument("tracker: neither a map nor keyframes");
    }
    if (options.keyframes) keyframes_.emplace(camera, *options.keyframes);
    setMap(std::move(map));
}
Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

void Tracker::setMap(std::shared_ptr<const ViewSource> map) {
    if (!map && !keyframes_) throw std::invalid_argument("tracker: no map, and no keyframes");
    map_ = map ? std::make_unique<MapAligner>(std::move(map), camera_, options_) : nullptr;
}

std::vector<TrackedFrame> Tracker::update(const Observation& observation) {
    now_ = observation.time;
    if (observation.T_next_now) {
        hasOdometry_ = true;
        odometry_.add(now_, *observation.T_next_now);
    }
    std::vector<TrackedFrame> tracked;
    for (const CameraFrame& frame : observation.frames) tracked.push_back(track(frame));
    if (hasOdometry_) loss_.onTime(now_);
    return tracked;
}

TrackedFrame Tracker::track(const CameraFrame& image) {
    const View& view = image.view;
    now_ = std::max(now_, image.time);
    const Pose stayed = belief_.mean;
    TrackedFrame frame;
    frame.time = image.time;
    predict(image.time);
    frame.predicted = belief_;
    if (image.vertical) correctByVertical(*image.vertical);
    if (const auto match = find(view, stayed, frame)) {
        onMatched(view, *match, stayed, frame);
    } else {
        onRejected(view, stayed, frame);
    }
    frame.T_c_w = belief_;
    return frame;
}

/// The belief at the time of an image.
void Tracker::predict(double time) {
    const UncertainPose motion = hasOdometry_
                                     ? odometry_.takeUntil(time)
                                     : velocity_.predict(imageTime_ ? time - *imageTime_ : 0.);
    imageTime_ = time;
    belief_ = compound(motion, belief_);
    for (Matrix6* since : {&sinceTracked_, &sinceKeyframe_}) {
        *since = compound(motion, {Pose::Identity(), *since}).covariance;
    }
    if (options_.mapErrors) options_.mapErrors->propagate(motion.mean);
}

/// The vertical of a camera turned by exp(phi^) is up_c + phi x up_c to first order.
void Tracker::correctByVertical(const MeasuredVertical& measured) {
    const Eigen::Vector3d up_c = belief_.mean.linear().col(2);
    Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
    J.rightCols<3>() = -hat(up_c);
    const double weight = 1. / (measured.sigma * measured.sigma);
    const Matrix6 information = weight * J.transpose() * J;
    const Vector6 right = weight * J.transpose() * (measured.up_c - up_c);
    if (options_.mapErrors) options_.mapErrors->observe(belief_.covariance, information);
    belief_.covariance = updateCovariance(belief_.covariance, information);
    belief_.mean = expSE3(belief_.covariance * right) * belief_.mean;
}

/// Finds the keyframes that the map in view was made of: their errors are errors of this map. Then
/// finds the surfaces of the map that the measured depth contradicts.
void Tracker::relateToMap(const ImageF& measuredDepth) {
    relation_.reset();
    MeasuredSurfaces* measured = map_ ? map_->measured() : nullptr;
    if (!map_ || (!options_.mapErrors && measured == nullptr)) return;
    View view;
    map_->map().render(camera_, belief_.mean, view);
    if (options_.mapErrors) relation_ = options_.mapErrors->relate(view, camera_, belief_);
    if (measured != nullptr) measured->measure(view, measuredDepth, camera_, priorInMap());
}

/// The belief of the pose in the map, whose errors are not those of the pose.
UncertainPose Tracker::priorInMap() const {
    return {belief_.mean, relation_ ? relation_->relative : belief_.covariance};
}

/// The belief in the world after a pose was found in the map.
UncertainPose Tracker::beliefAfter(const Match& match) {
    if (!relation_ || match.keyframe) return match.T_c_w;
    if (!match.isRelocalized) {
        return options_.mapErrors->align(*relation_, belief_, match.alignment);
    }
    return {match.T_c_w.mean, options_.mapErrors->relocalize(*relation_, match.alignment)};
}

/// @param stayed where the camera was at the last image
std::optional<Tracker::Match> Tracker::find(const View& view, const Pose& stayed,
                                            TrackedFrame& frame) {
    std::optional<Match> match;
    relateToMap(view.depth);
    if (map_) match = findInMap(view.intensity, stayed, frame);
    if (!match && keyframes_ && !keyframes_->isEmpty()) {
        match = findByKeyframes(view.intensity, stayed, frame);
    }
    if (match) return match;
    if (isUnmapped(frame)) {
        loss_.onUnmapped(now_);
        return {};
    }
    loss_.onRejected(now_, hasOdometry_, isBlack(view.intensity));
    return map_ && hasOdometry_ && loss_.isLost() ? findInNeighbourhood(view) : std::nullopt;
}

/// Whether an image shows what a map that is still being made does not: odometry has to do.
bool Tracker::isUnmapped(const TrackedFrame& frame) const {
    return options_.mapErrors && hasOdometry_ && !loss_.isLost() &&
           frame.alignment.verdict == Verdict::lostOverlap;
}

/// Whether an image agrees with what it was aligned to. Without odometry, one that does not inform
/// must not carry the extrapolated motion on; after a loss, little but the image supports the pose.
bool Tracker::agrees(const Alignment& alignment, const AlignmentOptions& options) const {
    if (isLost(alignment.verdict)) return false;
    if (!hasOdometry_ &&
        (isUninformative(alignment) || isTextureElsewhere(alignment.residual, options.trust))) {
        return false;
    }
    return !loss_.isLost() ||
           loss_.isExplained(alignment, options.trust, options.photometric.sigma);
}

std::optional<Tracker::Match> Tracker::findInMap(const ImageF& image, const Pose& stayed,
                                                 TrackedFrame& frame) {
    std::vector<UncertainPose> priors{priorInMap()};
    if (!hasOdometry_) priors.push_back({stayed, belief_.covariance});
    for (const UncertainPose& prior : priors) {
        Alignment alignment = map_->align(image, prior);
        if (&prior == &priors.front()) frame.alignment = alignment;
        if (!agrees(alignment, options_.map) || isAsUncertainAsLost(alignment.covariance)) continue;
        if (isResolvedBy(alignment, prior)) {
            if (relation_) alignment = MapErrors::withoutWeak(alignment, prior);
            return Match{alignment, {alignment.T_c_w, alignment.covariance}, {}, false};
        }
    }
    return {};
}

/// Whether tracking is not lost, or no longer after an image that agrees with the map.
bool Tracker::isResolvedBy(const Alignment& alignment, const UncertainPose& prior) const {
    if (!loss_.isLost() || alignment.verdict == Verdict::converged) return true;
    if (isUninformative(alignment)) return false;
    if (!hasOdometry_) {
        return resolvesLoss(trackedCovariance_, prior.covariance, alignment.covariance);
    }
    // The belief of a lost camera may be too narrow: the image must do without it.
    const Matrix6 wide = loss_.widened(prior).covariance;
    return resolvesLoss(prior.covariance, wide, updateCovariance(wide, alignment.information));
}

/// Perhaps it is not the image but the belief that is wrong.
std::optional<Tracker::Match> Tracker::findInNeighbourhood(const View& view) {
    const UncertainPose wide = loss_.widened(priorInMap());
    if (MeasuredSurfaces* measured = map_->measured()) {
        measured->measure(view.depth, camera_, wide);
    }
    const Alignment alignment = map_->align(view.intensity, wide);
    if (alignment.verdict != Verdict::converged || !agrees(alignment, options_.map)) return {};
    return Match{alignment, {alignment.T_c_w, alignment.covariance}, {}, true};
}

std::optional<Tracker::Match> Tracker::findByKeyframes(const ImageF& image, const Pose& stayed,
                                                       TrackedFrame& frame) {
    const AlignmentOptions& options = keyframes_->options().keyframe.alignment;
    /// @param before covariance relative to the keyframe at the image tracked last
    const auto match = [&](const Alignment& alignment,
                           const Matrix6& before) -> std::optional<Match> {
        if (!agrees(alignment, options)) return {};
        if (loss_.isLost() && alignment.verdict != Verdict::converged &&
            !resolvesLoss(before, before + sinceTracked_, alignment.covariance)) {
            return {};
        }
        return Match{alignment, keyframes_->beliefOf(alignment), keyframes_->latestTime(), false};
    };
    const auto align = [&](const Pose& likely) {
        return keyframes_->align(image, {likely, sinceKeyframe_});
    };
    const Matrix6 before = sinceKeyframe_ - sinceTracked_;
    const Pose& likely = hasOdometry_ ? belief_.mean : stayed;
    const Alignment first = align(belief_.mean);
    if (!map_) {
        frame.alignment = first;
        frame.keyframe = keyframes_->latestTime();
    }
    if (auto found = match(first, before)) return found;
    if (!hasOdometry_) {
        if (auto found = match(align(likely), before)) return found;
    }
    if (keyframes_->keepLastTracked()) {
        sinceKeyframe_ = sinceTracked_;
        if (auto found = match(align(likely), Matrix6::Zero())) return found;
    }
    const double share = options_.loss.maxUnexplainedShare;
    const auto relocalized = keyframes_->relocalize(image, share * options.trust.maxUnexplained);
    if (!relocalized) return {};
    sinceKeyframe_ = relocalized->covariance;
    return match(*relocalized, Matrix6::Zero());
}

/// The belief after an image that was found.
void Tracker::onMatched(const View& view, const Match& match, const Pose& before,
                        TrackedFrame& frame) {
    frame.alignment = match.alignment;
    frame.keyframe = match.keyframe;
    belief_ = beliefAfter(match);
    // The pose before is that of the last image tracked, images lost since then or not.
    if (!hasOdometry_ && trackedTime_) {
        const UncertainPose motion{frame.predicted.mean * before.inverse(), sinceTracked_};
        velocity_.observe(motionAfter(motion, frame.predicted, belief_),
                          frame.time - *trackedTime_);
    }
    trackedTime_ = frame.time;
    trackedCovariance_ = belief_.covariance;
    sinceTracked_.setZero();
    if (match.alignment.verdict == Verdict::converged) T_certain_w_ = belief_.mean;
    loss_.onTracked(now_);
    if (!keyframes_ || view.depth.getSize() == 0) return;
    if (keyframes_->isEmpty()) {
        if (keyframes_->begin(view, belief_, frame.time)) sinceKeyframe_.setZero();
    } else {
        const double overlap = match.keyframe ? match.alignment.overlap : 1.;
        const bool isNext =
            keyframes_->add(view, belief_, frame.time, overlap, match.alignment.meanDepth);
        if (isNext) sinceKeyframe_.setZero();
    }
}

/// The belief after a rejected image. Without a map the first image that shows anything begins a
/// chain of keyframes, at the start and, at the belief of then, after many rejected ones.
void Tracker::onRejected(const View& view, const Pose& stayed, TrackedFrame& frame) {
    frame.rejected = true;
    velocity_.forget();
    if (!hasOdometry_) {
        belief_.mean = stayed;
        if (map_) belief_ = bounded(belief_);
    }
    if (isMapInconsistent(view)) {
        frame.isMapInconsistent = true;
        loss_.onTracked(now_);
    }
    if (!keyframes_) return;
    keyframes_->forgetLastTracked();
    const bool isFirst = keyframes_->isEmpty() && !map_;
    if (!isFirst && !loss_.wantsFreshStart()) return;
    if (view.depth.getSize() == 0 || !keyframes_->begin(view, belief_, frame.time)) return;
    trackedTime_ = frame.time;
    trackedCovariance_ = belief_.covariance;
    sinceTracked_.setZero();
    sinceKeyframe_.setZero();
    loss_.onTracked(now_);
    if (!isFirst) return;
    frame.rejected = false;
    frame.alignment.verdict = Verdict::converged;
    frame.keyframe = frame.time;
}

/// Whether a map made on the flight has contradicted the images for long.
bool Tracker::isMapInconsistent(const View& view) const {
    return options_.mapErrors && hasOdometry_ && loss_.isLost() && !isBlack(view.intensity) &&
           now_ - *loss_.since() > options_.loss.inconsistentAfter;
}

/// Standard deviations that a belief may have, relative to its own.
Vector6 Tracker::roomOf(const Matrix6& covariance) const {
    Vector6 most;
    most << Eigen::Vector3d::Constant(options_.loss.maxTranslation),
        Eigen::Vector3d::Constant(options_.loss.maxRotation);
    return most.cwiseQuotient(covariance.diagonal().cwiseMax(1e-30).cwiseSqrt());
}

/// Without odometry, a pose that is as uncertain as that of a camera lost for long is none.
bool Tracker::isAsUncertainAsLost(const Matrix6& covariance) const {
    return !hasOdometry_ && roomOf(covariance).minCoeff() < 1.;
}

UncertainPose Tracker::bounded(UncertainPose belief) const {
    const Vector6 factor = roomOf(belief.covariance).cwiseMin(1.);
    belief.covariance = factor.asDiagonal() * belief.covariance * factor.asDiagonal();
    return belief;
}

}  // namespace photonav
