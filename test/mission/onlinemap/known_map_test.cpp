// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/known_map.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "exploration/exploration.hpp"
#include "io/error.hpp"
#include "map/octree_file.hpp"
#include "mission/exploration/room_to_explore.hpp"
#include "onlinemap/online_map.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

using Map = std::shared_ptr<const TexturedOcTree>;

/// A robot that explores a room with a map that an earlier flight made, or another one.
class KnownMap : public ::testing::Test {
  protected:
    ExplorationResult flown(Scene scene, const Map& known, std::uint32_t seed = 1) const {
        const World world(std::move(scene), config);
        const PlanningProblem problem(config, world);
        ExplorationSetup setup = setUpExploration(problem);
        setup.known = known;
        return explore(setup, config.planner, seed, kNotInterrupted);
    }

    /// The reason for which the map of the config is refused.
    std::string refusal() const {
        try {
            loadKnownMap(config);
        } catch (const InputError& error) {
            return error.what();
        }
        return "none";
    }

    Config config = test::flightThroughRoom();
};

std::shared_ptr<TexturedOcTree> withoutTexture(const TexturedOcTree& map) {
    auto bare = std::make_shared<TexturedOcTree>(map);
    for (auto leaf = bare->begin_leafs(); leaf != bare->end_leafs(); ++leaf) {
        leaf->faces = {};
        leaf->surfaces.clear();
    }
    return bare;
}

/// The first plan goes around the box, which the first flight met on its way.
/// How much sooner a flight ends depends on its seed: docs/experiments/explorations.md has the
/// mean of several.
TEST_F(KnownMap, TheFirstPlanOfTheSecondFlightKnowsTheDetour) {
    const ExplorationResult first = flown(test::roomToExplore(), nullptr);
    ASSERT_TRUE(first.hasArrived()) << first.reason;
    ASSERT_LT(first.updates.front().length, 6.3);
    const auto size = first.map->size();
    const ExplorationResult second = flown(test::roomToExplore(), first.map, 2);
    ASSERT_TRUE(second.hasArrived()) << second.reason;
    EXPECT_GT(second.updates.front().length, 6.2);
    EXPECT_GT(second.leastClearance, 0.125);
    EXPECT_EQ(first.map->size(), size);  // of its own copy
    const ExplorationResult bare = flown(test::roomToExplore(), withoutTexture(*first.map), 2);
    ASSERT_TRUE(bare.hasArrived()) << bare.reason;
    EXPECT_GT(bare.updates.front().length, 6.2);
    EXPECT_GT(bare.leastClearance, 0.125);
}

/// A wall that is no longer there bars every way in the map. The camera sees all of it.
TEST_F(KnownMap, IsCorrectedWhereSomethingIsGone) {
    config.camera.mount = "forward";
    config.goal.position.x() = 4.;
    const auto known = std::make_shared<TexturedOcTree>(config.explore.cell());
    const double cell = config.explore.cell();
    for (double y = 0.5 * cell; y < 4.; y += cell) {
        for (double z = 0.5 * cell; z < 3.; z += cell) {
            TexturedOcTreeNode* node = known->setNodeValue(3., y, z, 3.F);
            node->faces.fill({y + z < 3. ? 0.2F : 0.8F, 100.F});
        }
    }
    const ExplorationResult flight = flown(test::roomToExplore(), known);
    ASSERT_TRUE(flight.hasArrived()) << flight.reason;
    const TexturedOcTreeNode* there = flight.map->search(3., 2., 1.1);
    EXPECT_TRUE(there == nullptr || !flight.map->isNodeOccupied(there));
}

TEST_F(KnownMap, IsCorrectedWhereSomethingIsNew) {
    Scene before;
    const auto floor = addTexture(before, valueNoise({.size = {8., 4.}, .seed = 1}));
    const auto walls = addTexture(before, valueNoise({.size = {8., 3.}, .seed = 2}));
    addBox(before, {0., 0., 0.}, {8., 4., 3.}, walls, BoxInside::hollow);
    addPlane(before, {0., 0., 0.01}, {8., 0., 0.}, {0., 4., 0.}, floor);
    const ExplorationResult earlier = flown(std::move(before), nullptr);
    ASSERT_TRUE(earlier.hasArrived()) << earlier.reason;
    const ExplorationResult flight = flown(test::roomToExplore(), earlier.map, 2);
    EXPECT_LT(flight.updates.front().length, 6.3);  // through the box
    EXPECT_TRUE(flight.hasArrived()) << flight.reason;
    EXPECT_GT(flight.leastClearance, 0.125);
    EXPECT_GT(flight.flown, 6.2);
}

/// Cells that were free for long are occupied as soon as those of a new map.
TEST_F(KnownMap, IsNotMoreCertainThanAMapOfThisFlight) {
    TexturedOcTree known(config.explore.cell());
    known.setNodeValue(2., 2., 1., -3.F);
    const OnlineMap map(config, &known);
    const TexturedOcTreeNode* cell = map.cells()->search(2., 2., 1.);
    ASSERT_NE(cell, nullptr);
    EXPECT_GT(cell->getLogOdds(), -2. * map.cells()->getProbHitLog());
    EXPECT_TRUE(map.isSeen({2., 2., 1.}));
    EXPECT_EQ(map.whole().occupancy.size(), 1U);
}

TEST_F(KnownMap, DecidesTheSizeOfTheCells) {
    const test::TemporaryFolder folder;
    config.sceneFile = "scene.yaml";
    config.mapFile = (folder.path() / "map.ot").string();
    TexturedOcTree map(0.08);
    map.setNodeValue(3., 2., 1.1, 1.F);
    saveTexturedOcTree(map, config.mapFile);
    const World world(test::roomToExplore(), config);
    EXPECT_EQ(setUpExploration({config, world}).config.explore.cell(), 0.08);
    EXPECT_EQ(explorerOptions(config).config.explore.cell(), 0.08);
}

TEST_F(KnownMap, IsRefusedWhereItDoesNotFit) {
    const test::TemporaryFolder folder;
    config.file = "c.yaml";
    config.sceneFile = "scene.yaml";
    const auto save = [&](double resolution, double x) {
        TexturedOcTree map(resolution);
        if (x < 1e6) map.setNodeValue(x, 2., 1.1, 1.F);
        config.mapFile = (folder.path() / "map.ot").string();
        saveTexturedOcTree(map, config.mapFile);
    };
    save(0.05, 3.);
    EXPECT_EQ(refusal(), "none");
    save(0.005, 3.);
    EXPECT_NE(refusal().find("has cells of 0.005 m, an exploration may have 0.01 to 0.5 m"),
              std::string::npos)
        << refusal();
    save(0.1, 3.);
    EXPECT_EQ(refusal(), "none");
    config.explore.resolution = 0.05;
    EXPECT_NE(refusal().find("has cells of 0.1 m, explore.resolution is 0.05 m"), std::string::npos)
        << refusal();
    config.explore.resolution = {};
    save(0.05, 200.);
    EXPECT_NE(refusal().find("nothing of it is within"), std::string::npos) << refusal();
    save(0.05, 1e6);
    EXPECT_NE(refusal().find("is empty"), std::string::npos) << refusal();
    const World world(test::roomToExplore(), config);
    const PlanningProblem problem(config, world);
    save(0.05, config.start.position.x());
    try {
        setUpExploration(problem);
        ADD_FAILURE();
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find("c.yaml: map.file"), 0U) << error.what();
    }
    std::filesystem::remove(config.mapFile);
    EXPECT_EQ(refusal().find("c.yaml: map.file"), 0U) << refusal();
    config.sceneFile = "";  // the map is the world, which the robot does not know
    EXPECT_EQ(loadKnownMap(config), nullptr);
}

}  // namespace
}  // namespace photonav
