// SPDX-License-Identifier: BSD-3-Clause
// A robot that moves exactly as commanded: no part of the simulation.
#pragma once

#include "geometry/se3.hpp"
#include "photometry/view.hpp"
#include "robot/robot.hpp"

namespace photonav::test {

class ObedientRobot : public Robot {
  public:
    /// @param position_w where it begins
    /// @param imagePeriod an image comes with the first step after this time [s]
    ObedientRobot(std::shared_ptr<const ViewSource> world, const Camera& camera, const Pose& T_b_c,
                  const Eigen::Vector3d& position_w, double imagePeriod = 0.)
        : world_(std::move(world)), camera_(camera), T_b_c_(T_b_c), imagePeriod_(imagePeriod) {
        T_w_b.translation() = position_w;
    }

    Observation fly(const BodyVelocity& command, double seconds) override {
        Vector6 motion = Vector6::Zero();
        motion.head<3>() = seconds * command.linear;
        motion[5] = seconds * command.yawRate;
        const Pose T_now_next = expSE3(motion);
        T_w_b = T_w_b * T_now_next;
        lastCommand = command;
        time_ += seconds;
        Observation observation{time_, UncertainPose{T_now_next.inverse()}, {}};
        observation.T_next_now->covariance = odometryCovariance;
        if (isBlind || time_ < nextImage_) return observation;
        nextImage_ = time_ + imagePeriod_;
        CameraFrame& frame = observation.frames.emplace_back();
        frame.time = time_;
        world_->render(camera_, (T_w_b * T_b_c_).inverse(), frame.view);
        return observation;
    }
    const Camera& camera() const override { return camera_; }
    const Pose& T_b_c() const override { return T_b_c_; }
    double blur() const override { return kRenderedBlur; }

    Pose T_w_b = Pose::Identity();
    Matrix6 odometryCovariance = 1e-6 * Matrix6::Identity();  ///< of a step
    bool isBlind = false;
    BodyVelocity lastCommand;

  private:
    std::shared_ptr<const ViewSource> world_;
    Camera camera_;
    Pose T_b_c_;
    double imagePeriod_;
    double time_ = 0., nextImage_ = 0.;
};

}  // namespace photonav::test
