// SPDX-License-Identifier: BSD-3-Clause
#include "check/localisation_check.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "alignment/search_grid.hpp"
#include "check/predicted_image.hpp"
#include "estimation/loss_of_tracking.hpp"
#include "flight/arrival.hpp"
#include "flight/flight_setup.hpp"
#include "geometry/gaussian.hpp"
#include "geometry/se3.hpp"
#include "render/interruptible_views.hpp"

namespace photonav {
namespace {

constexpr double kLeastGain = 0.1;  // share of the trace that another heading must gain

/// A pose along the trajectory.
struct WayPlace {
    std::optional<double> time;
    Pose T_w_b = Pose::Identity();
    double length = 0., distance = 0.;
};

/// Way between two poses: of the position, and with turns counted.
std::pair<double, double> wayBetween(const Pose& a, const Pose& b, double rotationWeight) {
    const double length = (b.translation() - a.translation()).norm();
    const double angle = Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
    return {length, length + rotationWeight * angle};
}

std::optional<double> timeBetween(const GivenPose& a, const GivenPose& b, double share) {
    if (!a.time || !b.time) return {};
    return *a.time + share * (*b.time - *a.time);
}

/// Poses every `ds` along the straight motions of a trajectory, and its last one.
std::vector<WayPlace> placesAlong(const GivenTrajectory& trajectory, double ds,
                                  double rotationWeight) {
    const std::vector<GivenPose>& poses = trajectory.poses;
    std::vector<WayPlace> places{{poses.front().time, poses.front().T_w_b, 0., 0.}};
    double length = 0., distance = 0., next = ds;
    for (std::size_t i = 1; i < poses.size(); ++i) {
        const GivenPose &a = poses[i - 1], &b = poses[i];
        const auto [way, metric] = wayBetween(a.T_w_b, b.T_w_b, rotationWeight);
        for (; metric > 0. && next <= distance + metric; next += ds) {
            const double share = (next - distance) / metric;
            places.push_back({timeBetween(a, b, share), interpolate(a.T_w_b, b.T_w_b, share),
                              length + share * way, next});
        }
        length += way;
        distance += metric;
    }
    if (places.back().distance < distance - 1e-6 * ds) {
        places.push_back({poses.back().time, poses.back().T_w_b, length, distance});
    }
    return places;
}

/// When the camera is lost, from place to place.
class LossRule {
  public:
    LossRule(const CheckOptions& options, const Camera& camera)
        : options_(options), camera_(camera) {}

    /// Judges the image at a place. @returns whether it counts
    bool accepts(const Alignment& image, const Matrix6& prior) {
        if (isBlind_) return false;
        if (searchSpacing(prior, camera_, image.meanDepth) > kWidestSearchSpacing) {
            isBlind_ = true;
            return false;
        }
        if (photonav::isLost(image.verdict)) {
            isLost_ = isLost_ || ++rejectedInRow_ >= LossOptions().rejectedImages;
            return false;
        }
        rejectedInRow_ = 0;
        if (image.verdict == Verdict::converged) isLost_ = false;
        return !isLost_;
    }

    LossCause cause(double positionSigma) const {
        if (isBlind_) return LossCause::wideBelief;
        if (isLost_) return LossCause::rejectedImages;
        const bool isAbove = options_.maxSigma && positionSigma > *options_.maxSigma;
        return isAbove ? LossCause::maxSigma : LossCause::none;
    }

  private:
    const CheckOptions& options_;
    const Camera& camera_;
    bool isBlind_ = false;  ///< beyond the search, for good
    bool isLost_ = false;   ///< until an image determines all directions
    int rejectedInRow_ = 0;
};

/// The belief along a trajectory.
class Walk {
  public:
    /// @param views of the world
    Walk(const Config& config, const World& world, const ViewSource& views,
         const CheckOptions& options, IsStopped isStopped)
        : config_(config),
          options_(options),
          camera_(config.camera.camera()),
          T_b_c_(config.camera.T_b_c()),
          images_(views, camera_, config.photometric, alignmentIn(config, world),
                  std::move(isStopped)),
          loss_(options_, camera_) {
        const Pose T_c_b = T_b_c_.inverse();
        belief_.covariance = inOtherFrame(config.belief.initialCovariance, T_c_b);
        noise_ = inOtherFrame(config.belief.motionNoise, T_c_b);
    }

    CheckedPlace begin(const WayPlace& at) {
        belief_.mean = cameraAt(at.T_w_b);
        return see(at, config_.belief.viewAtStart ? 1. : 0.);
    }

    CheckedPlace next(const WayPlace& at, double step) {
        const Pose T_c_w = cameraAt(at.T_w_b);
        const UncertainPose motion{T_c_w * belief_.mean.inverse(), step * noise_};
        // The mean is not accumulated: rounding errors of rotations would double at every step.
        belief_ = {T_c_w, compound(motion, belief_, config_.belief.order).covariance};
        return see(at, step / config_.belief.ds);
    }

  private:
    /// How flights align images; the map itself counts as what is seen.
    static AlignmentOptions alignmentIn(const Config& config, const World& world) {
        if (world.map() == nullptr) return flightAlignment(config, MapKind::mesh, 0.);
        const MapKind kind = world.map()->hasSurfaces() ? MapKind::surfaces : MapKind::cells;
        return flightAlignment(config, kind, world.map()->getResolution());
    }

    Pose cameraAt(const Pose& T_w_b) const { return (T_w_b * T_b_c_).inverse(); }
    double trace(const Matrix6& covariance) const {
        return weightedTrace(covariance, config_.belief.characteristicLength);
    }

    /// Takes an image that counts as a share of one.
    CheckedPlace see(const WayPlace& at, double share) {
        const PredictedImage image = images_.at(belief_.mean);
        CheckedPlace place{.time = at.time,
                           .T_w_b = at.T_w_b,
                           .length = at.length,
                           .distance = at.distance,
                           .traceBefore = trace(belief_.covariance),
                           .overlap = image.alignment.overlap,
                           .verdict = image.alignment.verdict,
                           .openDirections = image.alignment.openDirections};
        if (options_.headings > 0) place.best = bestHeading(at.T_w_b);
        if (loss_.accepts(image.alignment, belief_.covariance)) {
            belief_.covariance = updateCovariance(belief_.covariance, share * image.information);
        }
        describeBelief(place);
        place.loss = loss_.cause(place.positionSigma);
        return place;
    }

    void describeBelief(CheckedPlace& place) const {
        place.covariance = belief_.covariance;
        place.trace = trace(belief_.covariance);
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> position(
            belief_.covariance.topLeftCorner<3, 3>());
        place.positionSigma = std::sqrt(std::max(0., position.eigenvalues()[2]));
        place.rotationSigma = largestSigma(belief_.covariance.bottomRightCorner<3, 3>());
        place.weakest_w = belief_.mean.linear().transpose() * position.eigenvectors().col(2);
        if (place.weakest_w.z() < 0.) place.weakest_w = -place.weakest_w;
    }

    /// The belief before the image is that of the trajectory: only the view turns.
    BestHeading bestHeading(const Pose& T_w_b) {
        const Matrix6 prior_w =
            inRotatedAxes(belief_.covariance, belief_.mean.linear().transpose());
        BestHeading best;
        for (int i = 0; i < options_.headings; ++i) {
            const double turn = 2. * std::numbers::pi * i / options_.headings;
            Pose T_w_turned = T_w_b;
            T_w_turned.linear() =
                Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * T_w_b.linear();
            const Pose T_c_w = cameraAt(T_w_turned);
            const PredictedImage image = images_.at(T_c_w);
            const Matrix6 prior = inRotatedAxes(prior_w, T_c_w.linear());
            best.traces.push_back(trace(isLost(image.alignment.verdict)
                                            ? prior
                                            : updateCovariance(prior, image.information)));
            if (i > 0 && best.traces.back() >= best.trace) continue;
            best.trace = best.traces.back();
            best.yaw = yawOf(T_w_turned);
        }
        best.ownTrace = best.traces.front();
        return best;
    }

    const Config& config_;
    const CheckOptions& options_;
    Camera camera_;
    Pose T_b_c_;
    ImagePredictor images_;
    LossRule loss_;
    Matrix6 noise_;  ///< per metre, camera frame
    UncertainPose belief_;
};

double meanTraceOf(const std::vector<CheckedPlace>& places) {
    double integral = 0.;
    for (std::size_t i = 1; i < places.size(); ++i) {
        integral += 0.5 * (places[i].distance - places[i - 1].distance) *
                    (places[i - 1].trace + places[i].traceBefore);
    }
    const double distance = places.back().distance;
    return distance > 0. ? integral / distance : places.back().trace;
}

}  // namespace

std::string nameOf(LossCause cause) {
    switch (cause) {
        case LossCause::none:
            return "none";
        case LossCause::rejectedImages:
            return "images rejected";
        case LossCause::wideBelief:
            return "the pose is more uncertain than the tracker's search covers";
        case LossCause::maxSigma:
            break;
    }
    return "above --max-sigma";
}

const CheckedPlace* CheckedTrajectory::firstLost() const {
    const auto lost = std::find_if(places.begin(), places.end(), [](const CheckedPlace& place) {
        return place.loss != LossCause::none;
    });
    return lost == places.end() ? nullptr : &*lost;
}

double CheckedTrajectory::lostLength() const {
    double sum = 0.;
    for (std::size_t i = 1; i < places.size(); ++i) {
        if (places[i].loss != LossCause::none) sum += places[i].length - places[i - 1].length;
    }
    return sum;
}

const CheckedPlace& CheckedTrajectory::worst() const {
    return *std::max_element(places.begin(), places.end(),
                             [](const CheckedPlace& a, const CheckedPlace& b) {
                                 return a.positionSigma < b.positionSigma;
                             });
}

double stepsOf(const GivenTrajectory& trajectory, const Config& config) {
    const std::vector<GivenPose>& poses = trajectory.poses;
    double way = 0.;
    for (std::size_t i = 1; i < poses.size(); ++i) {
        way += wayBetween(poses[i - 1].T_w_b, poses[i].T_w_b, config.rotationWeight).second;
    }
    return way / config.belief.ds;
}

CheckedTrajectory checkLocalisation(const GivenTrajectory& trajectory, const Config& config,
                                    const World& world, const CheckOptions& options,
                                    const std::atomic<bool>& interrupted,
                                    const std::function<void(double)>& onProgress) {
    const std::vector<WayPlace> places =
        placesAlong(trajectory, config.belief.ds, config.rotationWeight);
    const IsStopped isStopped = [&] { return interrupted.load(); };
    const InterruptibleViews views(world.sharedViews(), isStopped);
    Walk walk(config, world, views, options, isStopped);
    CheckedTrajectory checked;
    checked.places.push_back(walk.begin(places.front()));
    try {
        for (std::size_t i = 1; i < places.size() && !interrupted; ++i) {
            checked.places.push_back(
                walk.next(places[i], places[i].distance - places[i - 1].distance));
            if (onProgress)
                onProgress(static_cast<double>(i) / static_cast<double>(places.size() - 1));
        }
    } catch (const Interrupted&) {  // the places so far are whole
    }
    const CheckedPlace& last = checked.places.back();
    checked.length = last.length;
    checked.wholeLength = places.back().length;
    checked.meanTrace = meanTraceOf(checked.places);
    checked.arrivalTolerance = arrivalTolerance(config);
    // Where it was interrupted, the walk may be on the way to the next place.
    const Pose T_b_c = config.camera.T_b_c();
    const UncertainPose T_c_w{(last.T_w_b * T_b_c).inverse(), last.covariance};
    checked.arrivalProbability = probabilityWithin(
        bodyPosition(T_c_w, T_b_c), last.T_w_b.translation(), checked.arrivalTolerance);
    return checked;
}

GivenTrajectory withBestHeadings(const CheckedTrajectory& checked) {
    GivenTrajectory better{TrajectoryFormat::table, true, {}};
    for (const CheckedPlace& place : checked.places) {
        GivenPose pose{place.time, place.T_w_b};
        const bool isBetter =
            place.best && place.best->trace < (1. - kLeastGain) * place.best->ownTrace;
        if (isBetter) {
            const double turn = place.best->yaw - yawOf(place.T_w_b);
            pose.T_w_b.linear() =
                Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * pose.T_w_b.linear();
        }
        better.poses.push_back(pose);
    }
    return better;
}

}  // namespace photonav
