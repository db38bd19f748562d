// SPDX-License-Identifier: BSD-3-Clause
// Tracks the pose of the camera by odometry and images.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "alignment/wide_aligner.hpp"
#include "estimation/keyframe_chain.hpp"
#include "estimation/loss_of_tracking.hpp"
#include "estimation/map_errors.hpp"
#include "estimation/measured_motion.hpp"
#include "estimation/measured_surfaces.hpp"
#include "estimation/motion_model.hpp"
#include "estimation/observation.hpp"

namespace photonav {

struct TrackerOptions {
    AlignmentOptions map = {};  ///< alignment to the map
    /// Search the whole prior if it is wide (WideAligner), not only around its mean.
    bool searchPrior = false;
    /// Align to keyframes (earlier images with depth) if there is no map, or if the map does not
    /// explain the image. None: align to the map only.
    std::optional<KeyframeChainOptions> keyframes = {};
    /// Errors of a map that is built on the same flight at the beliefs of this tracker: the belief
    /// does not become more certain than the map in view. Null: the map is exact.
    std::shared_ptr<MapErrors> mapErrors = {};
    /// Of measured depth: surfaces of the map that it contradicts are left out (MeasuredSurfaces).
    /// None: measured depth is not compared with the map.
    std::optional<DepthAccuracy> depth = {};
    MotionNoise motion = {};  ///< of the motion between images, without odometry
    LossOptions loss = {};
    Pose T_b_c = Pose::Identity();  ///< mount of the camera on the body whose motion is measured
};

/// Tracks the belief T_c_w = exp(xi^) mean, xi ~ N(0, covariance) in the camera frame. Between
/// images the belief is propagated by odometry, or, without odometry, by the last velocity. Each
/// image is aligned to the map or to keyframes with the belief as prior; the result is the next
/// belief.
///
/// A measured vertical corrects the belief before the image of the same time is aligned.
///
/// After a rejected image the belief is the prediction. Tracking counts as lost after several
/// rejected images (LossOptions). Images are then aligned in a wider neighbourhood of the belief as
/// well. (An image that the latest keyframe does not explain is always aligned to the stored
/// keyframes, too.) An alignment ends the loss if it explains the image and reduces the covariance
/// in all directions that the loss has widened (resolvesLoss()). If this takes too long, a map that
/// is built on the same flight is doubted, not the odometry (TrackedFrame::isMapInconsistent).
/// Images may be late or missing.
class Tracker {
  public:
    /// @param map to align to; null: no map, which needs options.keyframes
    /// @param start belief T_c_w at the start
    /// @throws std::invalid_argument without map and keyframes, and as DenseAligner does
    Tracker(std::shared_ptr<const ViewSource> map, const Camera& camera, const UncertainPose& start,
            const TrackerOptions& options = {});
    ~Tracker();
    Tracker(Tracker&&) noexcept;
    Tracker& operator=(Tracker&&) noexcept;

    /// Replaces the map; the belief stays.
    /// @param map null: keyframes alone
    /// @throws std::invalid_argument without map and keyframes
    void setMap(std::shared_ptr<const ViewSource> map);

    /// Processes the odometry, then the images of an observation.
    /// @return one result per image
    std::vector<TrackedFrame> update(const Observation& observation);

    /// Processes the next image of a camera without odometry.
    /// @param view of the camera's size
    /// @param time time of the image, later than the time of the last image [s]
    /// @throws std::invalid_argument for a view of another size
    TrackedFrame track(const View& view, double time) { return track({time, view}); }

    /// Belief at the last image.
    const UncertainPose& beliefAtLastImage() const { return belief_; }
    /// Present belief: propagated by the odometry since the last image.
    UncertainPose belief() const { return compound(odometry_.pending(), belief_); }
    /// Belief at a later time [s], propagated by the last velocity without odometry.
    UncertainPose predicted(double time) const {
        return compound(velocity_.predict(imageTime_ ? time - *imageTime_ : 0.), belief_);
    }

    const LossOfTracking& loss() const { return loss_; }
    /// Camera pose T_c_w of the last image that determined all directions; the start before.
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
    void correctByVertical(const MeasuredVertical& measured);
    void relateToMap(const ImageF& measuredDepth);
    UncertainPose priorInMap() const;
    UncertainPose beliefAfter(const Match& match);
    std::optional<Match> find(const View& view, const Pose& stayed, TrackedFrame& frame);
    std::optional<Match> findInMap(const ImageF& image, const Pose& stayed, TrackedFrame& frame);
    std::optional<Match> findInNeighbourhood(const View& view);
    std::optional<Match> findByKeyframes(const ImageF& image, const Pose& stayed,
                                         TrackedFrame& frame);
    bool isUnmapped(const TrackedFrame& frame) const;
    bool agrees(const Alignment& alignment, const AlignmentOptions& options) const;
    bool isResolvedBy(const Alignment& alignment, const UncertainPose& prior) const;
    void onMatched(const View& view, const Match& match, const Pose& before, TrackedFrame& frame);
    void onRejected(const View& view, const Pose& stayed, TrackedFrame& frame);
    bool isMapInconsistent(const View& view) const;
    Vector6 roomOf(const Matrix6& covariance) const;
    bool isAsUncertainAsLost(const Matrix6& covariance) const;
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
    /// Covariance of the motion since the latest keyframe. It is not reduced by the images on the
    /// way: along directions that they do not show, the error grows until the next keyframe.
    Matrix6 sinceKeyframe_ = Matrix6::Zero();
    std::optional<double> trackedTime_;  ///< of the image tracked last [s]
    std::optional<double> imageTime_;    ///< of the last image [s]
    double now_ = 0.;                    ///< [s]
    bool hasOdometry_ = false;
};

}  // namespace photonav
