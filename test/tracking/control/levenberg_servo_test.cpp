// SPDX-License-Identifier: BSD-3-Clause
#include "control/levenberg_servo.hpp"

#include <gtest/gtest.h>

#include "geometry/se3.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

const LevenbergServoOptions kOptions{.gain = 2., .damping = 0.1};

/// A camera that looks down on a floor from 2 m, and its servo of the scene's twist.
struct OverFloor {
    MeshRenderer floor;
    Camera camera = makeCamera(94, 60, 1.2);
    Pose goal = lookFrom({0., 0., 2.}, test::kDown);

    explicit OverFloor(Texture texture) : floor(test::floorOf(std::move(texture))) {}

    View at(const Vector6& offset) const {
        View view;
        floor.render(camera, expSE3(offset) * goal, view);
        return view;
    }
    LevenbergServo servo(const LevenbergServoOptions& options = kOptions) const {
        return {at(Vector6::Zero()), camera, Matrix6::Identity(), options};
    }
};

OverFloor noise() { return OverFloor(valueNoise({.size = {20., 20.}, .seed = 3})); }

TEST(LevenbergServo, MovesAsItsHessianPredicts) {
    const OverFloor over = noise();
    const LevenbergServo servo = over.servo();
    const Eigen::MatrixXd& H = servo.information();
    Eigen::MatrixXd damped = H;
    damped.diagonal() *= 1.1;
    for (int i = 0; i < 6; ++i) {
        const Vector6 offset = 1e-4 * Vector6::Unit(i);
        const Eigen::VectorXd predicted = -2. * damped.ldlt().solve(H * offset);
        const Eigen::VectorXd velocity = servo.velocity(over.at(offset).intensity);
        EXPECT_LT((velocity - predicted).norm(), 0.1 * predicted.norm()) << i;
    }
}

TEST(LevenbergServo, HasModesThatShrinkEachAtItsRate) {
    const LevenbergServo servo = noise().servo();
    const auto [rates, directions] = servo.modes();
    const Eigen::MatrixXd& H = servo.information();
    Eigen::MatrixXd damped = H;
    damped.diagonal() *= 1.1;
    for (int i = 0; i < 6; ++i) {
        const Eigen::VectorXd d = directions.col(i);
        EXPECT_LT((2. * damped.ldlt().solve(H * d) - rates[i] * d).norm(), 1e-6 * d.norm());
        EXPECT_GE(rates[i], i > 0 ? rates[i - 1] : 0.);
    }
    EXPECT_LT(rates[0], 0.9 * rates[5]);
    const auto undamped = noise().servo({.gain = 2., .damping = 0.}).modes();
    EXPECT_NEAR(undamped.rates[0], 2., 1e-9);  // Gauss-Newton: all alike
}

TEST(LevenbergServo, LeavesOpenWhatTheViewDoesNotShow) {
    const OverFloor white(uniformTexture(0.5F));
    EXPECT_EQ(white.servo().modes().rates, Eigen::VectorXd::Zero(6));
    EXPECT_EQ(white.servo().velocity(white.at(Vector6::Constant(0.1)).intensity),
              Eigen::VectorXd::Zero(6));
    EXPECT_THROW(LevenbergServo(white.at(Vector6::Zero()), white.camera,
                                Eigen::MatrixXd::Zero(6, 0), kOptions),
                 std::invalid_argument);
}

}  // namespace
}  // namespace photonav
