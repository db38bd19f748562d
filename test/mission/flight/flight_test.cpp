// SPDX-License-Identifier: BSD-3-Clause
#include "flight/flight.hpp"

#include <gtest/gtest.h>

#include "geometry/se3.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

using test::kDown;

/// A floor of texture, a body above it, and a plan of 2 m along x with a turn at its end.
class Flight : public ::testing::Test {
  protected:
    Flight() {
        world.truth = world.map = floor;
        world.clearance = [](const Eigen::Vector3d&) { return 1.; };
        world.camera = makeCamera(94, 60, 1.2);
        world.T_b_c = cameraMount(kDown);
        world.noise = assumedNoise(options.tracker.map.photometric);
        Vector6 initial;
        initial << 1e-2, 1e-2, 1e-3, 1e-5, 1e-5, 1e-4;
        Vector6 motion;
        motion << 1e-3, 1e-3, 1e-3, 1e-5, 1e-5, 1e-4;
        options.robot.body.odometryNoise = motion.asDiagonal();
        const Matrix6 toCamera = adjoint(world.T_b_c.inverse());
        options.initialCovariance = toCamera * Matrix6(initial.asDiagonal()) * toCamera.transpose();
        for (int i = 0; i <= 10; ++i) {
            PlannedView view;
            view.T_w_b = levelPose({0.2 * i, 0., 2.}, 0.05 * i);
            view.distance = 0.2 * i;
            view.isWaypoint = i == 0 || i == 5 || i == 10;
            plan.push_back(view);
        }
    }

    std::shared_ptr<const MeshRenderer> floor =
        std::make_shared<MeshRenderer>(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3})));
    FlightWorld world;
    FlightOptions options;
    std::vector<PlannedView> plan;
};

TEST_F(Flight, ArrivesByItsImagesAlone) {
    for (options.seed = 1; options.seed <= 3; ++options.seed) {
        const FlightResult flight = fly(plan, world, options);
        EXPECT_EQ(nameOf(flight.end), "arrived");
        EXPECT_LT(flight.goalError, 0.02);
        EXPECT_TRUE(flight.photometric);
        EXPECT_EQ(flight.lostTime, 0.);
        const FlightSample& last = flight.samples.back();
        const Eigen::Vector3d error_w =
            last.belief.mean.inverse().translation() - last.T_c_w.inverse().translation();
        EXPECT_LT(error_w.norm(), 0.02);
    }
}

/// Waypoints every 10 cm, up to 2 cm beside the line.
std::vector<PlannedView> closeWaypoints(double length) {
    std::vector<PlannedView> plan;
    for (int i = 0; 0.1 * i <= length; ++i) {
        PlannedView view;
        view.T_w_b.translation() << 0.1 * i, 0.02 * std::sin(2. * i), 2.;
        view.distance = 0.1 * i;
        view.isWaypoint = true;
        plan.push_back(view);
    }
    return plan;
}

TEST_F(Flight, PassesCloseWaypointsAtItsSpeed) {
    options.initialCovariance *= 1e-2;
    plan = closeWaypoints(8.);
    const FlightResult one = fly(plan, world, options);
    EXPECT_EQ(nameOf(one.end), "arrived");
    EXPECT_GT(one.meanSpeed.value_or(0.), 0.85);
    options.pilot.route.limits.maxSpeed = 2.;
    options.robot.camera.period /= 2.;
    const FlightResult two = fly(plan, world, options);
    EXPECT_EQ(nameOf(two.end), "arrived");
    EXPECT_GT(two.meanSpeed.value_or(0.), 1.35);
}

/// Around the corner of a wall.
TEST_F(Flight, DoesNotCutCornersIntoObstacles) {
    constexpr double kPlanned = 0.2;  // clearance of the plan [m]
    world.clearance = [](const Eigen::Vector3d& p_w) {
        const Eigen::Vector2d outside(p_w.x() - 1.8, 0.2 - p_w.y());  // beyond both faces
        return std::max(outside.maxCoeff(), outside.cwiseMax(0.).norm());
    };
    options.initialCovariance *= 1e-2;
    const std::vector<Eigen::Vector2d> corners{
        {0., 0.}, {1.8 + kPlanned, 0.}, {1.8 + kPlanned, 2.}};
    plan.clear();
    for (const Eigen::Vector2d& corner : corners) {
        PlannedView& view = plan.emplace_back();
        view.T_w_b.translation() << corner, 2.;
        view.distance = corner.lpNorm<1>();
        view.isWaypoint = true;
    }
    for (options.seed = 1; options.seed <= 5; ++options.seed) {
        const FlightResult flight = fly(plan, world, options);
        EXPECT_EQ(nameOf(flight.end), "arrived");
        EXPECT_GT(flight.leastClearance, 0.5 * kPlanned);
        EXPECT_LT(flight.leastClearance, kPlanned);
        EXPECT_GT(flight.meanSpeed.value_or(0.), 0.6);
    }
}

TEST_F(Flight, ImagesHaveTheAssumedNoiseWithoutAnyOther) {
    const FlightResult assumed = fly(plan, world, options);
    world.noise = {};
    const FlightResult byDefault = fly(plan, world, options);
    EXPECT_EQ(byDefault.duration, assumed.duration);
    EXPECT_EQ(byDefault.goalError, assumed.goalError);
}

TEST_F(Flight, NamesWhatIsMissing) {
    const FlightWorld complete = world;
    world.clearance = {};
    EXPECT_THROW(fly(plan, world, options), std::invalid_argument);
    world = complete;
    world.truth = {};
    EXPECT_THROW(fly(plan, world, options), std::invalid_argument);
    world = complete;
    world.map = {};
    EXPECT_THROW(fly(plan, world, options), std::invalid_argument);
}

/// Tilt cannot be commanded, and a tilted view of the goal looks like one from beside it.
TEST_F(Flight, ATiltedBodyReachesTheGoalOnItsImage) {
    Vector6 motion = options.robot.body.odometryNoise.diagonal();
    motion.segment<2>(3).setConstant(2e-4);
    options.robot.body.odometryNoise = motion.asDiagonal();
    double byImage = 0., byBelief = 0.;
    for (options.seed = 1; options.seed <= 6; ++options.seed) {
        options.pilot.photometricGoal = true;
        byImage += fly(plan, world, options).goalError / 6.;
        options.pilot.photometricGoal = false;
        byBelief += fly(plan, world, options).goalError / 6.;
    }
    EXPECT_LT(byImage, 1.2 * byBelief);
    EXPECT_LT(byImage, 0.01);
}

TEST_F(Flight, IsTheSameForTheSameSeed) {
    options.robot.camera.dropRate = 0.2;
    const FlightResult a = fly(plan, world, options);
    const FlightResult b = fly(plan, world, options);
    ASSERT_EQ(a.samples.size(), b.samples.size());
    EXPECT_EQ(a.samples.back().T_c_w.matrix(), b.samples.back().T_c_w.matrix());
    EXPECT_EQ(a.samples.back().belief.covariance, b.samples.back().belief.covariance);
    options.seed = 2;
    EXPECT_NE(fly(plan, world, options).samples[0].T_c_w.matrix(), a.samples[0].T_c_w.matrix());
}

/// A sample is of its own image, however late that arrives.
TEST_F(Flight, SamplesAreOfTheImagesTakenThen) {
    const FlightSample atOnce = fly(plan, world, options).samples.front();
    EXPECT_LT(atOnce.belief.covariance.trace(), 0.1 * options.initialCovariance.trace());
    options.robot.camera.latency = 0.3;  // more than a period
    const FlightSample late = fly(plan, world, options).samples.front();
    EXPECT_TRUE(late.belief.covariance.isApprox(atOnce.belief.covariance, 1e-6));
    EXPECT_TRUE(late.belief.mean.isApprox(atOnce.belief.mean, 1e-6));
    options.robot.camera.dropRate = 1.;
    const FlightSample dropped = fly(plan, world, options).samples.front();
    EXPECT_EQ(dropped.belief.covariance, options.initialCovariance);
}

TEST_F(Flight, KeepsTrackOfLateAndDroppedImages) {
    options.robot.camera.latency = 0.3;  // more than a period
    options.robot.camera.dropRate = 0.3;
    const FlightResult flight = fly(plan, world, options);
    EXPECT_EQ(nameOf(flight.end), "arrived");
    EXPECT_LT(flight.images, static_cast<int>(flight.samples.size()));
    double worst = 0.;
    for (std::size_t i = 8; i < flight.samples.size(); ++i) {
        const FlightSample& s = flight.samples[i];
        worst = std::max(
            worst,
            (s.belief.mean.inverse().translation() - s.T_c_w.inverse().translation()).norm());
    }
    EXPECT_LT(worst, 0.08);  // 5 cm of odometry noise per root metre
}

TEST_F(Flight, StopsAndHoversThroughABlackoutAndGoesOn) {
    options.robot.camera.blackoutStart = 1.5;
    options.robot.camera.blackoutLength = 4.;
    const FlightResult flight = fly(plan, world, options);
    EXPECT_EQ(nameOf(flight.end), "arrived");
    EXPECT_EQ(flight.timesLost, 1);
    EXPECT_NEAR(flight.lostTime, 3.5, 0.6);
}

TEST_F(Flight, GivesUpInTheDark) {
    options.robot.camera.blackoutStart = 1.5;
    options.robot.camera.blackoutLength = 1e3;
    options.pilot.route.limits.maxSpeed = 0.5;
    options.pilot.giveUpTime = 5.;
    const FlightResult flight = fly(plan, world, options);
    EXPECT_EQ(nameOf(flight.end), "lost");
    EXPECT_LT(flight.duration, 10.);
    EXPECT_LT(flight.flown, 1.5) << "it must not go on blindly";
}

/// A world that is seen as from T T_c_w.
struct Shifted : ViewSource {
    std::shared_ptr<const ViewSource> world;
    Pose T;
    Shifted(std::shared_ptr<const ViewSource> w, const Pose& t) : world(std::move(w)), T(t) {}
    void render(const Camera& camera, const Pose& T_c_w, View& view) const override {
        world->render(camera, T * T_c_w, view);
    }
};

TEST_F(Flight, IsFoundAgainWhereTheHeadingIsWrong) {
    options.initialCovariance = 1e-6 * Matrix6::Identity();
    world.T_b_c = cameraMount(test::kOblique);
    const Eigen::Vector3d up_c = world.T_b_c.linear().row(2).transpose();
    const Vector6 turn = (Vector6() << Eigen::Vector3d::Zero(), 0.28 * up_c).finished();
    world.truth = std::make_shared<Shifted>(floor, expSE3(turn));
    options.pilot.photometricGoal = false;
    const FlightResult flight = fly(plan, world, options);
    const FlightSample& last = flight.samples.back();
    const Pose T_seen = expSE3(turn) * last.T_c_w;
    EXPECT_LT((last.belief.mean.inverse().translation() - T_seen.inverse().translation()).norm(),
              0.05)
        << nameOf(flight.end);
    EXPECT_EQ(flight.timesLost, 1);
    EXPECT_LT(flight.lostTime, 1.);
}

TEST_F(Flight, IsFoundAgainWhereTheEstimateIsWrong) {
    // The true start is far outside of what is believed.
    options.initialCovariance = 1e-6 * Matrix6::Identity();
    const Vector6 shift = (Vector6() << 0.25, 0.2, 0., 0., 0., 0.1).finished();
    world.truth = std::make_shared<Shifted>(floor, expSE3(shift));
    options.pilot.photometricGoal = false;
    const FlightResult flight = fly(plan, world, options);
    EXPECT_GE(flight.timesLost, 1);
    EXPECT_NE(nameOf(flight.end), "lost");
    const FlightSample& last = flight.samples.back();
    const Pose T_seen = expSE3(shift) * last.T_c_w;
    EXPECT_LT((last.belief.mean.inverse().translation() - T_seen.inverse().translation()).norm(),
              0.05);
}

/// The plan turns where a carpet comes into view. A robot half a metre beside that place does not
/// see the carpet. Its belief is wide enough to tell, and the pilot searches around the place.
TEST_F(Flight, LooksAroundForAViewThatItMissed) {
    world.truth = world.map = std::make_shared<MeshRenderer>(test::carpetOnWhite());
    Vector6 initial;
    initial << 1e-4, 0.25, 1e-4, 1e-5, 1e-5, 1e-5;
    const Matrix6 toCamera = adjoint(world.T_b_c.inverse());
    options.initialCovariance = toCamera * Matrix6(initial.asDiagonal()) * toCamera.transpose();
    for (PlannedView& view : plan) {
        view.T_w_b.linear().setIdentity();
        if (view.distance > 0.9) view.covariance = 1e-4 * Matrix6::Identity();
        const double back = 2. * std::max(0., view.distance - 1.);  // from the carpet
        view.T_w_b.translation() << std::min(view.distance, 1.), -1. - back, 2.;
        view.distance += 0.5 * back;
    }
    int found = 0;  // the carpet: certain enough to be at the goal, or at least near it
    int lost = 0;
    int astray = 0;
    for (const bool isSearching : {false, true}) {
        if (isSearching) options.pilot.clearance = world.clearance;
        int now = 0;
        for (options.seed = 1; options.seed <= 8; ++options.seed) {
            const FlightResult flight = fly(plan, world, options);
            const bool isAtGoal =
                flight.end == FlightEnd::arrived || flight.end == FlightEnd::uncertain;
            now += isAtGoal && flight.goalError < options.arrivalTolerance;
            lost += flight.end == FlightEnd::lost;
            astray += flight.end == FlightEnd::astray;
        }
        if (isSearching) {
            EXPECT_GT(now, found);
        }
        found = now;
    }
    EXPECT_GE(found, 7);
    EXPECT_GT(lost, 0) << "without a search it must not report an arrival";
    EXPECT_EQ(astray, 0);
}

TEST_F(Flight, EndsInACollision) {
    world.clearance = [](const Eigen::Vector3d& p_w) { return 1.2 - p_w.x(); };
    const FlightResult flight = fly(plan, world, options);
    EXPECT_EQ(nameOf(flight.end), "collided");
    EXPECT_LT(flight.leastClearance, options.bodyRadius);
}

/// With the covariance of its odometry, a flight over white is not certain of its goal.
TEST_F(Flight, ReportsNoArrivalThatIsNotCertain) {
    world.truth = world.map = std::make_shared<MeshRenderer>(test::floorOf(uniformTexture(0.9F)));
    const FlightResult flight = fly(plan, world, options);
    EXPECT_EQ(nameOf(flight.end), "uncertain arrival");
    EXPECT_FALSE(flight.hasArrived());
    EXPECT_GT(flight.arrivalProbability, 0.5);
    EXPECT_LT(flight.arrivalProbability, kArrivalConfidence);
    const FlightSample& last = flight.samples.back();
    ASSERT_TRUE(flight.believedGoal);
    const Pose T_w_b = (world.T_b_c * last.belief.mean).inverse();
    EXPECT_LT((flight.believedGoal->mean_w - T_w_b.translation()).norm(), 0.05);
    EXPECT_NEAR(std::sqrt(flight.believedGoal->covariance(0, 0)), 0.11, 0.02);  // 0.1^2 + 2 m flown
}

/// False arrivals: the odometry is far worse than believed, and no image contradicts it.
TEST_F(Flight, EndsAstrayOverWhite) {
    options.initialCovariance *= 0.01;
    options.arrivalTolerance = 0.4;
    world.truth = world.map = std::make_shared<MeshRenderer>(test::floorOf(uniformTexture(0.9F)));
    options.robot.body.odometryFactor = 50.;
    int astray = 0;
    for (options.seed = 1; options.seed <= 8; ++options.seed) {
        const FlightResult flight = fly(plan, world, options);
        EXPECT_FALSE(flight.photometric);
        if (flight.end != FlightEnd::astray) continue;
        ++astray;
        EXPECT_GT(flight.goalError, options.arrivalTolerance);
    }
    EXPECT_GT(astray, 0);
}

}  // namespace
}  // namespace photonav
