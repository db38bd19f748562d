// SPDX-License-Identifier: BSD-3-Clause
#include "control/waypoint_servo.hpp"

#include <visp3/visual_features/vpFeatureThetaU.h>
#include <visp3/visual_features/vpFeatureTranslation.h>

#include "control/mav_task.hpp"

namespace photonav {

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

WaypointServo::WaypointServo(const Pose& T_b_c, double gain)
    : impl_(std::make_unique<Impl>(T_b_c, gain)) {}
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
