// SPDX-License-Identifier: BSD-3-Clause
// What is said where unknown cells are in the way.
#include <gtest/gtest.h>

#include "io/error.hpp"
#include "problem/planning_problem.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

TEST(UnknownCells, AreNamedAsTheReasonWhereNoOccupiedCellIsNear) {
    Config config = loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml");
    config.file = "map.yaml";
    const Eigen::Vector3d p = config.start.position;
    const auto map = std::make_shared<TexturedOcTree>(0.1);
    const auto message = [&] {
        const World world(map, config);
        const PlanningProblem problem(config, world);
        return test::messageOf<InputError>([&] { problem.checkPlace("start", config.start); });
    };
    map->updateNode(p.x(), p.y(), p.z(), false);
    EXPECT_TRUE(message().starts_with("map.yaml: start: in collision: clearance")) << message();
    EXPECT_TRUE(message().ends_with(", next to unknown cells (map.unknown: occupied)"));
    map->updateNode(p.x(), p.y(), p.z(), 3.5F);
    EXPECT_TRUE(message().ends_with("robot.radius 0.3 m")) << message();
}

}  // namespace
}  // namespace photonav
