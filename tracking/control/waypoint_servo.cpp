// SPDX-License-Identifier: BSD-3-Clause
#include "control/waypoint_servo.hpp"

#include <visp3/visual_features/vpFeatureThetaU.h>
#include <visp3/visual_features/vpFeatureTranslation.h>

#include <algorithm>

#include "control/mav_task.hpp"

namespace photonav {

BodyVelocity limited(const BodyVelocity& wanted, const BodyVelocity& last,
                     const ServoOptions& options, double dt) {
    const double excess = std::max({1., wanted.linear.norm() / options.maxSpeed,
                                    std::abs(wanted.yawRate) / options.maxYawRate});
    BodyVelocity command{wanted.linear / excess, wanted.yawRate / excess};
    const Eigen::Vector3d change = command.linear - last.linear;
    const double most = options.maxAcceleration * dt;
    if (change.norm() > most) command.linear = last.linear + change * (most / change.norm());
    const double turn = options.maxYawAcceleration * dt;
    command.yawRate = last.yawRate + std::clamp(command.yawRate - last.yawRate, -turn, turn);
    return command;
}

struct WaypointServo::Impl {
    vpFeatureTranslation t{vpFeatureTranslation::cdMc};
    vpFeatureThetaU tu{vpFeatureThetaU::cdRc};
    vpServo task;

    Impl(const Pose& T_b_c, double gain) {
        setUpMavTask(task, T_b_c, gain);
        task.setInteractionMatrixType(vpServo::CURRENT);
        task.addFeature(t);  // wanted: zero
        task.addFeature(tu);
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() { task.kill(); }
};

WaypointServo::WaypointServo(const Pose& T_b_c, const ServoOptions& options)
    : impl_(std::make_unique<Impl>(T_b_c, options.gain)) {}
WaypointServo::~WaypointServo() = default;
WaypointServo::WaypointServo(WaypointServo&&) noexcept = default;
WaypointServo& WaypointServo::operator=(WaypointServo&&) noexcept = default;

BodyVelocity WaypointServo::toward(const Pose& T_c_w, const Pose& T_goal_w) {
    const vpHomogeneousMatrix cdMc = toVisp(T_goal_w * T_c_w.inverse());
    impl_->t.buildFrom(cdMc);
    impl_->tu.buildFrom(cdMc);
    return bodyVelocityFrom(impl_->task.computeControlLaw());
}

}  // namespace photonav
