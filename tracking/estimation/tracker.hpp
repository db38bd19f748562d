// SPDX-License-Identifier: BSD-3-Clause
// Where the camera is, from odometry and images.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "alignment/wide_aligner.hpp"
#include "estimation/keyframe_chain.hpp"
#include "estimation/loss_of_tracking.hpp"
#include "estimation/map_errors.hpp"
#include "estimation/measured_motion.hpp"
#include "estimation/motion_model.hpp"
#include "estimation/observation.hpp"

namespace photonav {

struct TrackerOptions {
    AlignmentOptions map = {};  ///< alignment to the map
    /// Search all of the prior where it is wide (WideAligner), not only around its mean.
    bool searchPrior = false;
    /// Align to earlier images where there is no map, or where it does not explain the image; such
    /// images need depth. None: the map alone.
    std::optional<KeyframeChainOptions> keyframes = {};
    /// Errors of a map that is made on the same flight, at the beliefs of this tracker alone: the
    /// belief never becomes better than the map in view. None: the map is exact.
    std::shared_ptr<MapErrors> mapErrors = {};
    MotionNoise motion = {};  ///< where there is no odometry
    LossOptions loss = {};
    Pose T_b_c = Pose::Identity();  ///< camera mount on the body that odometry is of
};

/// The belief T_c_w = exp(xi^) mean, xi ~ N(0, covariance) in the camera frame. Between images it
/// is propagated with odometry, or, without any, with the velocity so far; each image is aligned to
/// the map with the belief as prior, or to keyframes, and the belief is then that of the alignment.
///
/// A measured vertical corrects the belief before the image of the same time is aligned.
///
/// A rejected image leaves the prediction. Tracking counts as lost after several of them
/// (LossOptions); then the same images are aligned in a wider neighbourhood, and to remembered
/// keyframes, and one ends the loss when it explains the image and leaves no direction as wide as
/// the loss has made it. Where no image does for long, a map that is made on the flight is doubted
/// rather than the odometry (TrackedFrame::isMapDoubted). Images may be late or missing.
class Tracker {
  public:
    /// @param map to align to; null: none, which needs options.keyframes
    /// @param start belief T_c_w
    /// @throws std::invalid_argument without map and keyframes, and as DenseAligner does
    Tracker(std::shared_ptr<const ViewSource> map, const Camera& camera, const UncertainPose& start,
            const TrackerOptions& options = {});
    ~Tracker();
    Tracker(Tracker&&) noexcept;
    Tracker& operator=(Tracker&&) noexcept;

    /// Exchanges the map; the belief stays. Null: keyframes alone.
    void setMap(std::shared_ptr<const ViewSource> map);

    /// Odometry, then images. @return one for every image
    std::vector<TrackedFrame> update(const Observation& observation);

    /// The next image of a camera without odometry.
    /// @param view of the camera's size @throws std::invalid_argument otherwise
    /// @param time [s] larger than the one before
    TrackedFrame track(const View& view, double time) { return track({time, view}); }

    /// Belief at the last image.
    const UncertainPose& beliefAtLastImage() const { return belief_; }
    /// Belief of now: odometry since the last image included.
    UncertainPose belief() const { return compound(odometry_.pending(), belief_); }
    /// Belief at a later time, without odometry.
    UncertainPose predicted(double time) const {
        return compound(velocity_.predict(imageTime_ ? time - *imageTime_ : 0.), belief_);
    }

    const LossOfTracking& loss() const { return loss_; }
    /// Camera pose of the last image that determined all directions.
    const Pose& lastCertainView() const { return T_certain_w_; }

  private:
    struct Match {
        Alignment alignment;
        UncertainPose T_c_w;
        std::optional<double> keyframe;
        bool isRelocalized = false;  ///< found without the belief
    };
    class MapAligner;

    TrackedFrame track(const CameraFrame& image);
    void predict(double time);
    void level(const MeasuredVertical& measured);
    void relateToMap();
    UncertainPose priorInMap() const;
    Matrix6 covarianceOf(const Match& match);
    std::optional<Match> find(const View& view, const Pose& stayed, TrackedFrame& frame);
    std::optional<Match> findInMap(const ImageF& image, const Pose& stayed, TrackedFrame& frame);
    std::optional<Match> findInNeighbourhood(const ImageF& image);
    std::optional<Match> findByKeyframes(const ImageF& image, const Pose& stayed,
                                         TrackedFrame& frame);
    bool isUnmapped(const TrackedFrame& frame) const;
    bool agrees(const Alignment& alignment, const AlignmentOptions& options) const;
    bool isResolvedBy(const Alignment& alignment, const UncertainPose& prior) const;
    void take(const View& view, const Match& match, const Pose& before, TrackedFrame& frame);
    void miss(const View& view, const Pose& stayed, TrackedFrame& frame);
    bool isMapDoubted(const View& view) const;
    UncertainPose bounded(UncertainPose belief) const;

    Camera camera_;
    TrackerOptions options_;
    std::unique_ptr<MapAligner> map_;              ///< null: none
    std::optional<MapErrors::Relation> relation_;  ///< of the last image to the map's errors
    std::optional<KeyframeChain> keyframes_;
    MeasuredMotion odometry_;
    MotionModel velocity_;
    LossOfTracking loss_;

    UncertainPose belief_;  ///< at the last image
    Pose T_certain_w_;
    Matrix6 trackedCovariance_;               ///< of the belief at the image tracked last
    Matrix6 sinceTracked_ = Matrix6::Zero();  ///< covariance of the motion since then
    std::optional<double> trackedTime_;       ///< and its time [s]
    std::optional<double> imageTime_;         ///< of the last image [s]
    double now_ = 0.;                         ///< [s]
    bool hasOdometry_ = false;
};

}  // namespace photonav
