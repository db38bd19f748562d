// SPDX-License-Identifier: BSD-3-Clause
// Collects odometry between images.
#pragma once

#include <deque>

#include "geometry/se3.hpp"
#include "geometry/uncertain_pose.hpp"

namespace photonav {

/// Odometry of the camera since the last image. Images may arrive late: odometry after an exposure
/// is kept until the image of this exposure has arrived.
class MeasuredMotion {
  public:
    /// @param T_b_c camera mount
    explicit MeasuredMotion(const Pose& T_b_c)
        : T_c_b_(T_b_c.inverse()), toCamera_(adjoint(T_c_b_)) {}

    /// Adds a measured motion of the body that ends at `time` [s].
    /// @param T_next_now covariance of the left perturbation, in the next body frame
    void add(double time, const UncertainPose& T_next_now) {
        steps_.push_back({time,
                          {T_c_b_ * T_next_now.mean * T_c_b_.inverse(),
                           toCamera_ * T_next_now.covariance * toCamera_.transpose()}});
        pending_ = joined(steps_.back().T_next_now, pending_);
    }

    /// Motion T_next_now of the camera from the last image to an exposure [s], which becomes the
    /// last image. Steps of odometry that end later are kept.
    UncertainPose takeUntil(double exposure) {
        UncertainPose motion;
        while (!steps_.empty() && steps_.front().time <= exposure) {
            motion = joined(steps_.front().T_next_now, motion);
            steps_.pop_front();
        }
        pending_ = {};
        for (const Step& step : steps_) pending_ = joined(step.T_next_now, pending_);
        return motion;
    }

    /// Motion of the camera since the last image.
    const UncertainPose& pending() const { return pending_; }

  private:
    struct Step {
        double time;
        UncertainPose T_next_now;  ///< of the camera
    };
    static UncertainPose joined(const UncertainPose& later, const UncertainPose& earlier) {
        return compound(later, earlier, PropagationOrder::second);  // of a few steps: tiny
    }

    Pose T_c_b_;
    Matrix6 toCamera_;  // adjoint of T_c_b
    std::deque<Step> steps_;
    UncertainPose pending_;
};

}  // namespace photonav
