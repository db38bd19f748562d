// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "control/motion_limits.hpp"
#include "control/photometric_servo.hpp"
#include "control/waypoint_servo.hpp"
#include "geometry/se3.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

using test::kDown;
using test::kOblique;

Pose moved(const Pose& T_w_b, const BodyVelocity& velocity, double dt) {
    Vector6 motion = Vector6::Zero();
    motion.head<3>() = dt * velocity.linear;
    motion[5] = dt * velocity.yawRate;
    return T_w_b * expSE3(motion);
}

TEST(Limited, KeepsDirectionSpeedAndAcceleration) {
    const MotionLimits options{.maxSpeed = 1., .maxYawRate = 0.5, .maxAcceleration = 2.};
    const BodyVelocity fast{{3., 4., 0.}, 0.1};
    const BodyVelocity now = limited(fast, {{0.6, 0.8, 0.}, 0.02}, options, 0.1);
    EXPECT_TRUE(now.linear.isApprox(Eigen::Vector3d(0.6, 0.8, 0.)));
    EXPECT_NEAR(now.yawRate, 0.02, 1e-12);
    const BodyVelocity begun = limited(fast, {}, options, 0.1);
    EXPECT_NEAR(begun.linear.norm(), 0.2, 1e-12);
    const BodyVelocity turning = limited({{1., 0., 0.}, 5.}, {{0.1, 0., 0.}, 0.5}, options, 0.1);
    EXPECT_NEAR(turning.yawRate, 0.5, 1e-12);
    EXPECT_NEAR(turning.linear.x(), 0.1, 1e-12);  // a tenth of the speed, as of the turn
}

class ServoWithMount : public ::testing::TestWithParam<double> {};

TEST_P(ServoWithMount, ReachesAPlannedViewFromAnywhere) {
    const Pose T_b_c = cameraMount(GetParam());
    WaypointServo servo(T_b_c, 1.5);
    const Pose T_w_goal = levelPose({1., -2., 1.5}, 2.);
    Pose T_w_b = Pose::Identity();
    for (int i = 0; i < 200; ++i) {
        const BodyVelocity velocity =
            servo.toward((T_w_b * T_b_c).inverse(), (T_w_goal * T_b_c).inverse());
        T_w_b = moved(T_w_b, velocity, 0.05);
        EXPECT_NEAR(T_w_b(2, 2), 1., 1e-9) << "it stays level";
    }
    EXPECT_TRUE(T_w_b.isApprox(T_w_goal, 1e-3));
}

TEST_P(ServoWithMount, ReachesTheGoalsImage) {
    const MeshRenderer room(test::texturedRoom());
    const Camera camera = makeCamera(188, 120, 1.2);
    const Pose T_b_c = cameraMount(GetParam());
    Pose T_w_goal = Pose::Identity();
    T_w_goal.translation() << 2., 3., 1.5;
    PhotometricServo servo(room, camera, T_b_c, T_w_goal, {});
    EXPECT_TRUE(servo.isInformative());
    Pose T_w_b = T_w_goal;
    T_w_b.translation() += Eigen::Vector3d(0.03, -0.03, 0.02);
    T_w_b.linear() = (Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitZ()) *
                      Eigen::AngleAxisd(0.02, Eigen::Vector3d(0.6, 0.8, 0.)))
                         .toRotationMatrix();  // it hangs askew, which no command mends
    View view;
    for (int i = 0; i < 30; ++i) {
        room.render(camera, (T_w_b * T_b_c).inverse(), view);
        const auto step = servo.toward(view.intensity, T_w_b);
        EXPECT_TRUE(step.isTrusted);
        T_w_b = moved(T_w_b, step.velocity, 0.25);
    }
    EXPECT_LT((T_w_b.translation() - T_w_goal.translation()).norm(), 4e-3);
}

INSTANTIATE_TEST_SUITE_P(Mounts, ServoWithMount, ::testing::Values(kDown, kOblique));

TEST(PhotometricServo, RejectsTheImageOfAnotherPlaceAndOfAWhiteFloor) {
    const MeshRenderer floor(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3})));
    const Camera camera = makeCamera(94, 60, 1.2);
    Pose T_w_goal = Pose::Identity();
    T_w_goal.translation() << 0., 0., 2.;
    PhotometricServo servo(floor, camera, cameraMount(kDown), T_w_goal, {});
    View elsewhere;
    floor.render(camera, lookFrom({3., 1., 2.}, kDown), elsewhere);
    EXPECT_FALSE(servo.toward(elsewhere.intensity, T_w_goal).isTrusted);
    const MeshRenderer white(test::floorOf(uniformTexture(0.9F)));
    EXPECT_FALSE(PhotometricServo(white, camera, cameraMount(kDown), T_w_goal, {}).isInformative());
}

}  // namespace
}  // namespace photonav
