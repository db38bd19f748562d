// SPDX-License-Identifier: BSD-3-Clause
#include "check/localisation_check.hpp"

#include <gtest/gtest.h>

#include "check/check_result.hpp"
#include "check/obstruction.hpp"
#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "io/interrupted.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

GivenTrajectory through(const std::vector<Eigen::Vector4d>& places) {
    GivenTrajectory trajectory{TrajectoryFormat::table, true, {}};
    for (const Eigen::Vector4d& place : places) {
        GivenPose pose;
        pose.T_w_b = levelPose(place.head<3>(), place[3]);
        trajectory.poses.push_back(pose);
    }
    return trajectory;
}

/// The paper's first scene: white where x < 4.95 m, the floor ends at x = 12 m, y = 12.5 m.
Config twoTextures(const std::vector<std::string>& overrides = {}) {
    return loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml", overrides);
}

const CheckOptions kWithoutHeadings{.headings = 0};

/// Beliefs are those of the planner, but for the cells of its information field.
TEST(LocalisationCheck, BeliefsAreThoseOfThePlanner) {
    const Config config =
        twoTextures({"planner.view_pitch=1e-4", "planner.view_rotation_pitch=1e-4"});
    const World world(config);
    const std::vector<Place> places{
        {{0., 0., 2.}, M_PI / 2}, {{0., 3., 2.}, {}}, {{6., 3., 2.}, {}}};
    const EvaluatedPath expected = PlanningProblem(config, world).evaluate("given", places);
    const CheckedTrajectory checked = checkLocalisation(
        through({{0., 0., 2., M_PI / 2}, {0., 3., 2., M_PI / 2}, {6., 3., 2., M_PI / 2}}), config,
        world, kWithoutHeadings);
    ASSERT_EQ(checked.places.size(), expected.points.size());
    for (std::size_t i = 0; i < checked.places.size(); ++i) {
        const BeliefPoint& point = expected.points[i];
        EXPECT_TRUE(checked.places[i].covariance.isApprox(point.covariance, 0.01)) << i;
        EXPECT_NEAR(checked.places[i].traceBefore, point.traceBefore, 0.01 * point.traceBefore);
        EXPECT_NEAR(checked.places[i].length, point.length, 1e-9);
    }
    EXPECT_NEAR(checked.meanTrace, expected.meanTrace, 0.01 * expected.meanTrace);
    EXPECT_FALSE(checked.isLost());
    EXPECT_FALSE(checked.places.back().best);
}

TEST(LocalisationCheck, HowDenselyATrajectoryIsSampledDoesNotMatter) {
    const Config config = twoTextures();
    const World world(config);
    std::vector<Eigen::Vector4d> dense;
    for (int i = 0; i <= 300; ++i) dense.emplace_back(0.02 * i, 3., 2., 0.);
    const auto fine = checkLocalisation(through(dense), config, world, kWithoutHeadings);
    const auto coarse =
        checkLocalisation(through({dense.front(), dense.back()}), config, world, kWithoutHeadings);
    ASSERT_EQ(fine.places.size(), coarse.places.size());
    EXPECT_NEAR(fine.meanTrace, coarse.meanTrace, 1e-6 * coarse.meanTrace);
}

TEST(LocalisationCheck, AUniformFloorLeavesAllDirectionsOpenButIsNoLoss) {
    const Config config = twoTextures();
    const World world(config);
    const auto checked = checkLocalisation(through({{0., 0., 2., 0.}, {0., 4., 2., 0.}}), config,
                                           world, kWithoutHeadings);
    EXPECT_FALSE(checked.isLost());
    const CheckedPlace& last = checked.places.back();
    EXPECT_EQ(last.verdict, Verdict::degenerate);
    EXPECT_EQ(last.openDirections.size(), 6U);
    // Nothing but the start and the odometry: variances add up, turning adds to the position.
    EXPECT_GT(last.positionSigma, std::sqrt(0.115 + 4. * 1e-4));
    EXPECT_EQ(&checked.worst(), &last);
}

/// Beyond the floor's edge the map predicts nothing: the third image in a row that is rejected
/// loses the camera, and one that determines everything finds it again.
TEST(LocalisationCheck, SeveralImagesWithoutTheMapLoseTheCamera) {
    const Config config = twoTextures({"bounds=[[-1,-0.5,2],[30,9.5,2]]"});
    const World world(config);
    const auto checked =
        checkLocalisation(through({{8., 4., 2., 0.}, {16., 4., 2., 0.}, {8., 4., 2., 0.}}), config,
                          world, kWithoutHeadings);
    ASSERT_TRUE(checked.isLost());
    std::size_t first = 0;
    while (checked.places[first].verdict != Verdict::lostOverlap) ++first;
    EXPECT_EQ(checked.firstLost(), &checked.places[first + 2]);
    EXPECT_EQ(checked.firstLost()->loss, LossCause::rejectedImages);
    EXPECT_LT(checked.places[first].overlap, 0.2);
    EXPECT_GT(checked.places[first - 1].overlap, 0.2);
    // A rejected image does not count.
    EXPECT_EQ(checked.places[first].trace, checked.places[first].traceBefore);
    EXPECT_EQ(checked.places.back().loss, LossCause::none);
    EXPECT_LT(checked.places.back().positionSigma, 0.02);
    EXPECT_GT(checked.lostLength(), 5.);
    EXPECT_LT(checked.lostLength(), 9.);
}

TEST(LocalisationCheck, ABeliefWiderThanTheSearchIsLostForGood) {
    const Config config = twoTextures({"noise.motion=[1,1,0.01,1e-6,1e-6,1e-5]"});
    const World world(config);
    const auto checked =
        checkLocalisation(through({{0., 0., 2., 0.}, {0., 8., 2., 0.}, {8., 8., 2., 0.}}), config,
                          world, kWithoutHeadings);
    ASSERT_TRUE(checked.isLost());
    EXPECT_EQ(checked.firstLost()->loss, LossCause::wideBelief);
    EXPECT_GT(checked.firstLost()->positionSigma, 0.8);
    EXPECT_EQ(checked.places.back().loss, LossCause::wideBelief);  // over texture
    EXPECT_EQ(checked.places.back().verdict, Verdict::converged);
    EXPECT_GT(checked.places.back().positionSigma, checked.firstLost()->positionSigma);
    EXPECT_LT(checked.arrivalProbability, 0.1);
}

TEST(LocalisationCheck, AGivenLimitIsALossWhereItIsExceeded) {
    const Config config = twoTextures();
    const World world(config);
    CheckOptions options = kWithoutHeadings;
    options.maxSigma = 0.1;
    const auto checked =
        checkLocalisation(through({{0., 0., 2., 0.}, {8., 0., 2., 0.}}), config, world, options);
    EXPECT_EQ(checked.firstLost(), &checked.places.front());
    EXPECT_EQ(checked.firstLost()->loss, LossCause::maxSigma);
    EXPECT_EQ(checked.places.back().loss, LossCause::none);
    EXPECT_GT(checked.arrivalProbability, 0.99);
}

TEST(LocalisationCheck, TheWeakestDirectionIsAcrossTheTexture) {
    const test::TemporaryFolder folder;
    folder.write("bars.yaml", R"(
textures: [{name: bars, type: stripes, width: 0.5, soft_edge: 0.05, direction: u}]
planes: [{corner: [-20, -20, 0], u: [40, 0, 0], v: [0, 40, 0], texture: bars}]
)");
    const Config config = parseConfig(
        "scene: {file: bars.yaml}\nbounds: [[-5, -5, 2], [5, 5, 2]]\nstart: [0, 0, 2]\n"
        "goal: [4, 0, 2]\n",
        folder.file("config.yaml"));
    const World world(config);
    const auto checked = checkLocalisation(through({{0., 0., 2., 0.}, {4., 0., 2., 0.}}), config,
                                           world, kWithoutHeadings);
    EXPECT_GT(std::abs(checked.places.back().weakest_w.y()), 0.999);
    EXPECT_EQ(checked.places.back().verdict, Verdict::degenerate);
    EXPECT_EQ(checked.places.back().openDirections.size(), 1U);
}

/// A corridor whose left wall is textured and whose right wall is white: forward cameras should
/// look left.
class Corridor : public testing::Test {
  protected:
    Corridor() {
        folder_.write("corridor.yaml", R"(
textures:
  - {name: white, type: uniform, grey: 0.8}
  - {name: noise, type: noise, size: [8, 8], cells: [0.6, 0.3, 0.15], amplitudes: [0.2, 0.14, 0.08]}
walls:
  - {footprint: [[-10, 2], [20, 2]], height: 4, thickness: 0.2, texture: noise}
  - {footprint: [[-10, -2], [20, -2]], height: 4, thickness: 0.2, texture: white}
)");
        config_ = parseConfig(
            "scene: {file: corridor.yaml}\nbounds: [[-1, -1.5, 0.5], [11, 3.5, 3.5]]\n"
            "start: [0, 0, 2, 0]\ngoal: [10, 0, 2]\ncamera: {mount: forward}\n"
            "noise: {motion: [1e-3, 1e-3, 1e-3, 2e-5, 2e-5, 5e-4]}\n",
            folder_.file("config.yaml"));
    }

    test::TemporaryFolder folder_;
    Config config_;
};

TEST_F(Corridor, TheBestHeadingLooksAtTheTexture) {
    const World world(config_);
    const auto checked = checkLocalisation(
        through({{0., 0., 2., -M_PI / 2}, {10., 0., 2., -M_PI / 2}}), config_, world, {});
    for (const CheckedPlace& place : checked.places) {
        ASSERT_TRUE(place.best);
        EXPECT_EQ(place.best->traces.size(), 24U);
        EXPECT_GT(place.best->yaw, 0.);
        EXPECT_LT(place.best->yaw, M_PI);
        EXPECT_LT(place.best->trace, 0.5 * place.best->ownTrace);
        EXPECT_EQ(place.best->trace,
                  *std::min_element(place.best->traces.begin(), place.best->traces.end()));
    }
    const GivenTrajectory turned = withBestHeadings(checked);
    const auto better = checkLocalisation(turned, config_, world, kWithoutHeadings);
    EXPECT_LT(better.meanTrace, 0.5 * checked.meanTrace);
}

TEST_F(Corridor, BeliefsStayConsistentOnALongTurningTrajectory) {
    const World world(config_);
    std::vector<Eigen::Vector4d> zigzag;
    for (int i = 0; i <= 12; ++i) zigzag.emplace_back(i % 2 == 0 ? 0. : 8., 0., 2., 0.5 + 0.2 * i);
    const auto checked = checkLocalisation(through(zigzag), config_, world, kWithoutHeadings);
    EXPECT_GT(checked.places.size(), 380U);
    for (const CheckedPlace& place : checked.places) {
        ASSERT_TRUE(place.covariance.allFinite());
        EXPECT_LT(place.positionSigma, 0.2);
    }
    EXPECT_FALSE(checked.isLost());
    EXPECT_GT(checked.arrivalProbability, 0.9);
}

TEST_F(Corridor, HeadingsThatGainLittleStay) {
    const World world(config_);
    CheckedTrajectory checked = checkLocalisation(through({{0., 0., 2., 1.}, {2., 0., 2., 1.}}),
                                                  config_, world, {.headings = 4});
    for (CheckedPlace& place : checked.places) place.best->trace = 0.95 * place.best->ownTrace;
    for (const GivenPose& pose : withBestHeadings(checked).poses) {
        EXPECT_NEAR(yawOf(pose.T_w_b), 1., 1e-12);
    }
}

TEST_F(Corridor, CollisionsAndPlacesOutOfBoundsAreStretches) {
    const World world(config_);
    const Obstruction found = obstructionOf(
        through({{0., 0., 2., 0.}, {0., 4., 2., 0.}, {-2., 4., 2., 0.}}), config_, world);
    ASSERT_EQ(found.collisions.size(), 1U);  // the wall and a radius of 0.2 m on both sides
    EXPECT_NEAR(found.collisions[0].begin, 1.7, 0.15);
    EXPECT_NEAR(found.collisions[0].end, 2.3, 0.15);
    ASSERT_EQ(found.outside.size(), 1U);
    EXPECT_NEAR(found.outside[0].begin, 3.5, 0.03);
    EXPECT_NEAR(found.outside[0].end, 6., 1e-9);
    EXPECT_LE(found.leastClearance, 0.05);
}

TEST_F(Corridor, AnInterruptedCheckKeepsThePlacesSoFar) {
    const World world(config_);
    std::atomic<bool> interrupted{false};
    const auto checked = checkLocalisation(through({{0., 0., 2., 0.}, {10., 0., 2., 0.}}), config_,
                                           world, kWithoutHeadings, interrupted,
                                           [&](double share) { interrupted = share >= 0.5; });
    EXPECT_EQ(checked.places.size(), 21U);
    EXPECT_NEAR(checked.length, 5., 1e-9);
    EXPECT_NEAR(checked.wholeLength, 10., 1e-9);
    EXPECT_EQ(verdictOf(checked), "interrupted: the camera stays localised for the first 5.00 m");
}

TEST(LocalisationCheck, IsInterruptedInsideALargeView) {
    const Config config = twoTextures({"camera.width=2000", "camera.height=1100"});
    const World world(config);
    const std::atomic<bool> interrupted{true};
    EXPECT_THROW(checkLocalisation(through({{6., 3., 2., 0.}, {7., 3., 2., 0.}}), config, world,
                                   kWithoutHeadings, interrupted),
                 Interrupted);
}

}  // namespace
}  // namespace photonav
