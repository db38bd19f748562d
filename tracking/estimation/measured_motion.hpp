// SPDX-License-Identifier: BSD-3-Clause
// Collects odometry between images.
#pragma once

#include <deque>
#include <optional>

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

    /// Adds a measured motion of the body that ends at `time` [s] and begins where the one before
    /// ended. Where the first one begins is not known: it counts as a motion at its end.
    /// @param T_next_now covariance of the left perturbation, in the next body frame
    void add(double time, const UncertainPose& T_next_now) {
        const double begin = lastTime_.value_or(time);
        lastTime_ = time;
        steps_.push_back({begin,
                          time,
                          {T_c_b_ * T_next_now.mean * T_c_b_.inverse(),
                           toCamera_ * T_next_now.covariance * toCamera_.transpose()}});
        pending_ = joined(steps_.back().T_next_now, pending_);
    }

    /// Motion T_next_now of the camera from the last image to an exposure [s], which becomes the
    /// last image. What was measured later is kept; a step of odometry in which the exposure lies
    /// is divided by its time, at constant velocity.
    UncertainPose takeUntil(double exposure) {
        UncertainPose motion;
        while (!steps_.empty() && steps_.front().end <= exposure) {
            motion = joined(steps_.front().T_next_now, motion);
            steps_.pop_front();
        }
        if (!steps_.empty() && steps_.front().begin < exposure) {
            Step& step = steps_.front();
            const double share = (exposure - step.begin) / (step.end - step.begin);
            motion = joined(part(step.T_next_now, share), motion);
            step = {exposure, step.end, part(step.T_next_now, 1. - share)};
        }
        pending_ = {};
        for (const Step& step : steps_) pending_ = joined(step.T_next_now, pending_);
        return motion;
    }

    /// Motion of the camera since the last image.
    const UncertainPose& pending() const { return pending_; }

  private:
    struct Step {
        double begin, end;         ///< [s]
        UncertainPose T_next_now;  ///< of the camera
    };
    static UncertainPose part(const UncertainPose& T, double share) {
        return {expSE3(share * logSE3(T.mean)), share * T.covariance};
    }
    static UncertainPose joined(const UncertainPose& later, const UncertainPose& earlier) {
        return compound(later, earlier, PropagationOrder::second);  // of a few steps: tiny
    }

    Pose T_c_b_;
    Matrix6 toCamera_;  // adjoint of T_c_b
    std::deque<Step> steps_;
    std::optional<double> lastTime_;  // end of the last step [s]
    UncertainPose pending_;
};

}  // namespace photonav
