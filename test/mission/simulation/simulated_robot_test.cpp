// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulated_robot.hpp"

#include <gtest/gtest.h>

#include "geometry/se3.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

using test::kDown;

TEST(SimulatedMav, FollowsCommandsWithALag) {
    SimulatedMav mav(Pose::Identity(), {.lag = 0.5}, 1);
    const BodyVelocity command{{1., 0., 0.}, 0.};
    for (int i = 0; i < 25; ++i) mav.step(command, 0.02);
    EXPECT_NEAR(mav.velocity().linear.x(), 1. - std::exp(-1.), 1e-9);
    EXPECT_NEAR(mav.T_w_b().translation().x(), 0.5 - 0.5 * (1. - std::exp(-1.)), 1e-9);
}

/// Without new commands to the side, a body that turns flies straight on.
TEST(SimulatedMav, KeepsItsVelocityInTheWorldWhileItTurns) {
    SimulatedMav mav(Pose::Identity(), {.lag = 1e3}, 1);
    for (int i = 0; i < 100; ++i) mav.step({{1e3, 0., 0.}, 0.}, 0.01);  // to 1 m/s
    const Eigen::Vector3d before = mav.velocity().linear;
    for (int i = 0; i < 100; ++i) mav.step({mav.velocity().linear, 2e3}, 0.01);
    const Eigen::Matrix3d R_w_b = mav.T_w_b().linear();
    EXPECT_LT(R_w_b(0, 0), 0.6) << "it has turned";
    EXPECT_TRUE((R_w_b * mav.velocity().linear).isApprox(before, 0.01));
    EXPECT_NEAR(mav.T_w_b().translation().y(), 0., 0.01);
}

/// Odometry of 300 flights of two seconds along an arc.
struct MeasuredArcs {
    explicit MeasuredArcs(const MavOptions& options) {
        for (int seed = 1; seed <= kFlights; ++seed) {
            SimulatedMav mav(Pose::Identity(), options, static_cast<std::uint64_t>(seed));
            UncertainPose T_now_start;
            for (int i = 0; i < 20; ++i) {
                T_now_start = compound(mav.step({{0.5, 0.2, 0.}, 0.4}, 0.1), T_now_start);
            }
            const Vector6 xi = logSE3(mav.T_w_b().inverse() * T_now_start.mean.inverse());
            nees += xi.dot(T_now_start.covariance.ldlt().solve(xi)) / 6. / kFlights;
            rotation += xi.tail<3>().squaredNorm() / 3. / kFlights;
        }
    }
    static constexpr int kFlights = 300;
    double nees = 0.;      ///< mean, per degree of freedom
    double rotation = 0.;  ///< mean square error per axis [rad^2]
};

TEST(SimulatedMav, ItsOdometryHasTheStatedCovariance) {
    Vector6 variances;
    variances << 1e-3, 2e-3, 1e-3, 1e-5, 1e-5, 1e-4;
    EXPECT_NEAR(MeasuredArcs({.lag = 0., .odometryNoise = variances.asDiagonal()}).nees, 1., 0.1);
}

/// A gyroscope that is much better than odometry decides about the rotation, over two seconds.
TEST(SimulatedMav, FusesItsGyroscope) {
    Vector6 variances;
    variances << 1e-3, 2e-3, 1e-3, 1e-3, 1e-3, 1e-3;
    const MavOptions options{
        .lag = 0., .odometryNoise = variances.asDiagonal(), .gyroscopeNoise = 1e-3};
    const MeasuredArcs good(options);
    EXPECT_NEAR(good.nees, 1., 0.1);
    EXPECT_NEAR(good.rotation, 2e-6, 3e-7);

    MavOptions poor = options;
    poor.gyroscopeNoise = 0.03;  // as good as odometry: 1e-3 per metre, 0.64 m/s with the turns
    const MeasuredArcs both(poor);
    EXPECT_NEAR(both.nees, 1., 0.1);
    EXPECT_LT(both.rotation,
              0.65 * MeasuredArcs({.lag = 0., .odometryNoise = variances.asDiagonal()}).rotation);
}

TEST(SimulatedCamera, MeasuresTheVerticalAsExactlyAsItSays) {
    const MeshRenderer floor(test::floorOf(valueNoise({.seed = 3})));
    const Pose T_c_w = lookFrom({0., 0., 2.}, test::kOblique);
    SimulatedCamera camera(floor, makeCamera(8, 8, 1.), {}, {.verticalSigma = 0.02, .period = 0.1},
                           1);
    const Eigen::Vector3d up_c = T_c_w.linear().col(2);
    double sum = 0.;
    constexpr int kImages = 2000;
    for (int i = 0; i < kImages; ++i) {
        camera.expose(0.1 * i, T_c_w);
        const auto image = camera.receive(0.1 * i);
        ASSERT_TRUE(image && image->vertical);
        EXPECT_EQ(image->vertical->sigma, 0.02);
        sum += image->vertical->up_c.cross(up_c).squaredNorm();
    }
    EXPECT_NEAR(std::sqrt(sum / kImages / 2.), 0.02, 1e-3);
    SimulatedCamera without(floor, makeCamera(8, 8, 1.), {}, {.period = 0.1}, 1);
    without.expose(0., T_c_w);
    EXPECT_FALSE(without.receive(0.)->vertical);
}

TEST(SimulatedCamera, DeliversLateDropsAndGoesBlack) {
    const MeshRenderer floor(test::floorOf(valueNoise({.seed = 3})));
    const Pose T_c_w = lookFrom({0., 0., 2.}, kDown);
    const SimulatedCameraOptions options{.period = 0.1,
                                         .latency = 0.25,
                                         .dropRate = 0.25,
                                         .blackoutStart = 50.,
                                         .blackoutLength = 10.};
    SimulatedCamera camera(floor, makeCamera(8, 8, 1.), {}, options, 1);
    int taken = 0, received = 0, black = 0;
    for (int i = 0; i <= 10000; ++i) {
        const double time = 0.01 * i;
        taken += camera.expose(time, T_c_w).has_value();
        while (const auto image = camera.receive(time)) {
            ++received;
            black += image->view.intensity[4][4] == 0.F;
            EXPECT_GE(time - image->time, 0.25 - 1e-6);
            EXPECT_LT(time - image->time, 0.27);
        }
    }
    EXPECT_EQ(taken, 1001);
    EXPECT_NEAR(received, 748, 40);
    EXPECT_NEAR(black, 75, 13);
}

/// Drift moves a hovering body a little, and its odometry measures it.
TEST(SimulatedMav, DriftsALittleWhereItHovers) {
    Vector6 variances;
    variances << 1e-6, 1e-6, 1e-6, 1e-8, 1e-8, 1e-8;
    const MavOptions options{.odometryNoise = variances.asDiagonal(), .drift = 0.05};
    double squares = 0.;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        SimulatedMav mav(Pose::Identity(), options, seed);
        UncertainPose T_now_start;
        for (int i = 0; i < 100; ++i) T_now_start = compound(mav.step({}, 0.1), T_now_start);
        const Eigen::Vector3d way = mav.T_w_b().translation();
        EXPECT_GT(way.norm(), 0.);
        EXPECT_LT((T_now_start.mean.inverse().translation() - way).norm(), 0.1 * way.norm() + 0.01);
        squares += way.squaredNorm() / 3. / 50.;
    }
    // Integral over 10 s of a velocity of 0.05 m/s correlated over 2 s: 2 s^2 T (t - T (1 -
    // e^-t/T)).
    EXPECT_NEAR(std::sqrt(squares), 0.284, 0.06);
}

class RobotWithDepth : public ::testing::TestWithParam<DepthSensor> {};

/// Depth comes with the noise of its sensor, and changes no image.
TEST_P(RobotWithDepth, MeasuresTheFloor) {
    const auto floor =
        std::make_shared<MeshRenderer>(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3})));
    const Camera camera = makeCamera(188, 120, 1.2);
    Pose T_w_b = Pose::Identity();
    T_w_b.translation().z() = 2.;
    SimulatedRobotOptions options;
    options.camera.depth = GetParam();
    options.camera.pairNoise = assumedNoise({.sigma = 0.01});
    SimulatedRobot robot(floor, camera, cameraMount(kDown), T_w_b, assumedNoise({.sigma = 0.01}),
                         options, 1);
    const Observation observation = robot.fly({}, 0.);
    ASSERT_EQ(observation.frames.size(), 1U);
    ASSERT_TRUE(robot.exposed());
    const View& view = observation.frames[0].view;
    if (GetParam() == DepthSensor::none) {
        EXPECT_EQ(view.depth.getSize(), 0U);
        return;
    }
    ASSERT_EQ(view.depth.getSize(), view.intensity.getSize());
    EXPECT_EQ(robot.camera().width, view.intensity.getWidth());
    int measured = 0;
    double squares = 0.;
    for (unsigned i = 0; i < view.depth.getSize(); ++i) {
        if (view.depth.bitmap[i] <= 0.F) continue;
        ++measured;
        squares += std::pow(view.depth.bitmap[i] - 2., 2);
    }
    EXPECT_GT(measured, 0.4 * view.depth.getSize());
    EXPECT_LT(measured, view.depth.getSize());
    const double rms = std::sqrt(squares / measured);
    EXPECT_GT(rms, 0.004);
    EXPECT_LT(rms, 0.15);
}

INSTANTIATE_TEST_SUITE_P(Sensors, RobotWithDepth,
                         ::testing::Values(DepthSensor::none, DepthSensor::rgbd,
                                           DepthSensor::stereo));

TEST(SimulatedCamera, StereoWorksAtTheLeastHeightOfACamera) {
    const MeshRenderer floor(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3})));
    SimulatedCamera camera(floor, makeCamera(94, 8, 1.2), {}, {.depth = DepthSensor::stereo}, 1);
    ASSERT_TRUE(camera.expose(0., lookFrom({0., 0., 2.}, kDown)));
    const auto frame = camera.receive(0.);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->view.depth.getHeight(), 8U);
}

class BlankFloor : public ::testing::Test {
  protected:
    /// Depth that a stereo camera measures from a height of 2 m.
    ImageF depth(double projector) const {
        const MeshRenderer floor(test::floorOf(uniformTexture(0.6F)));
        const SimulatedCameraOptions options{.depth = DepthSensor::stereo,
                                             .projector = projector,
                                             .pairNoise = assumedNoise({.sigma = 0.02})};
        SimulatedCamera camera(floor, makeCamera(188, 120, 1.2),
                               assumedNoise({.sigma = 0.02, .scale = 0.08}), options, 1);
        EXPECT_TRUE(camera.expose(0., lookFrom({0., 0., 2.}, kDown)));
        return camera.receive(0.)->view.depth;
    }
    static double share(const ImageF& depth, double least, double most) {
        return static_cast<double>(std::count_if(depth.bitmap, depth.bitmap + depth.getSize(),
                                                 [&](float z) { return z > least && z < most; })) /
               depth.getSize();
    }
};

/// Noise that is correlated between pixels stands for errors of a model. It is not in the pair: it
/// would look like texture.
TEST_F(BlankFloor, StereoFindsNothing) { EXPECT_LT(share(depth(0.), 0., 100.), 0.01); }

TEST_F(BlankFloor, AProjectorGivesItTexture) {
    const ImageF found = depth(1.);
    EXPECT_GT(share(found, 1.8, 2.2), 0.55);  // the rest is near the borders
    EXPECT_LT(share(found, 0., 1.8) + share(found, 2.2, 100.), 0.02);
}

}  // namespace
}  // namespace photonav
