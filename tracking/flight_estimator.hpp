// SPDX-License-Identifier: BSD-3-Clause
// Where the camera is now, from images that show where it was.
#pragma once

#include <deque>

#include "pose_filter.hpp"
#include "wide_aligner.hpp"

namespace photonav {

/// The filter follows the images, which arrive late; the odometry measured since the last of them
/// is put on top for the belief of now. Dropped frames only make the way between images longer.
class FlightEstimator {
  public:
    /// @param start belief T_c_w
    /// @param T_b_c camera mount
    FlightEstimator(const UncertainPose& start, const Pose& T_b_c);

    /// The body has moved.
    /// @param T_next_now measured motion of the body and its covariance, body frame
    void move(const UncertainPose& T_next_now);

    /// An image is taken now.
    void expose(double time);

    /// An image taken at an exposure has arrived.
    Alignment receive(WideAligner& aligner, double exposureTime, const ImageF& image);

    /// Replaces the belief at the last exposure received: found again.
    void reset(const UncertainPose& T_c_w) { filter_ = PoseFilter(T_c_w); }

    /// Belief at the last exposure received.
    const UncertainPose& atLastImage() const { return filter_.belief(); }
    /// Belief of now.
    UncertainPose belief() const;

  private:
    struct Segment {
        double end;                ///< time of the exposure that closed it [s]
        UncertainPose T_next_now;  ///< of the camera
    };

    PoseFilter filter_;
    Pose T_c_b_;
    Matrix6 toCamera_;  // adjoint of T_c_b
    std::deque<Segment> closed_;
    UncertainPose open_;
};

}  // namespace photonav
