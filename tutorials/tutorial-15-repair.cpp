// SPDX-License-Identifier: BSD-3-Clause
// A map that changes: what a planner keeps when the map changes, and what planning from
// scratch costs. A robot flies 6 m through a room and sees a box that its map did not have.
#include <cstdio>

#include "exercises.hpp"
#include "geometry/se3.hpp"
#include "io/stopwatch.hpp"
#include "long_room.hpp"
#include "map/map_fusion.hpp"
#include "problem/planning_problem.hpp"
#include "render/mesh_renderer.hpp"

using namespace photonav;

namespace {

Scene room(bool hasBox) {
    const Eigen::AlignedBox3d box(Eigen::Vector3d(4.02, 1.22, 0.),
                                  Eigen::Vector3d(4.62, 2.42, 1.8));
    return longRoom(2.5, hasBox ? std::optional(box) : std::nullopt);
}

Config flightThrough() {
    Config config = flightThroughLongRoom("20");  // degrees below the horizon
    config.belief.kappa = 1000.;
    config.vertices = 500;
    config.field.positionPitch = 0.25;
    config.field.rotationPitch = 0.2;
    config.unknownToPlanner = UnknownPolicy::free;
    return config;
}

/// What the robot's camera sees becomes part of its map.
MapChange look(TexturedOcTree& map, const MeshRenderer& scene, const Config& config, double x,
               double yaw) {
    const Pose T_w_b = levelPose({x, 2., 1.1}, yaw);
    const Pose T_c_w = (T_w_b * config.camera.T_b_c()).inverse();
    View view;
    scene.render(config.camera.camera(), T_c_w, view);
    return fuse(map, view, config.camera.camera(), T_c_w);
}

struct Effort {
    double seconds = 0.;
    std::size_t views = 0;
    double cost = 0.;
};

/// Grows a planner to its number of vertices.
Effort solve(BeliefPlanner& planner) {
    const std::size_t before = planner.model().field().views();
    const Stopwatch watch;
    planner.solve(ompl::base::PlannerTerminationCondition([] { return false; }));
    return {watch.seconds(), planner.model().field().views() - before, planner.bestCost()};
}

/// Images of the box until the map holds its near face for occupied.
int imagesUntilOccupied(TexturedOcTree& map, const MeshRenderer& withBox, const Config& config) {
    const octomap::point3d face(4.03F, 1.83F, 1.13F);
    for (int images = 0;; ++images) {
        const auto* cell = map.search(face);
        if (cell != nullptr && map.isNodeOccupied(*cell)) return images;
        look(map, withBox, config, 2.5, 0.);
    }
}

void print(const char* what, const Effort& effort) {
    std::printf("%-28s %8.0f ms %6zu views   J %.3f\n", what, 1e3 * effort.seconds, effort.views,
                effort.cost);
}

}  // namespace

int main(int argc, char** argv) {
    const Config config = flightThrough();
    const MeshRenderer empty(room(false)), withBox(room(true));
    const auto map = std::make_shared<TexturedOcTree>(0.05);
    for (double x = 0.5; x < 7.6; x += 0.5) {
        for (int i = 0; i < 6; ++i) look(*map, empty, config, x, i * 1.047);
    }

    const std::vector<Exercise> exercises{
        {[&] { return double(imagesUntilOccupied(*map, withBox, config)); }, 0.},
        {[&] { return double(look(*map, withBox, config, 2.5, 0.).bricks().size()); }, 0.05}};
    if (const auto code = checkAnswers(argc, argv, exercises)) return *code;

    //! [plan]
    World world(std::shared_ptr<const TexturedOcTree>(map), config);
    PlanningProblem problem(config, world);
    const auto planner = problem.makePlanner("belief_rrt_star");
    print("first plan", solve(*planner));
    //! [plan]

    //! [change]
    MapChange change;  // a box has appeared: many images saw none, so that it takes several
    for (int i = 0; i < 10; ++i) change.join(look(*map, withBox, config, 2.5, 0.));
    const Stopwatch watch;
    world.mapChanged(change);  // clearance, and the views' snapshot of the map
    problem.followMap();       // cached views, and what of the roadmap is in collision now
    ompl::base::ScopedState<> here(problem.spaceInformation());
    problem.space().setState(here.get(), {2.5, 2., 1.1}, 0.);
    planner->moveRoot(here.get(), planner->model().root(here.get()));
    const double seconds = watch.seconds();
    Effort repaired = solve(*planner);
    repaired.seconds += seconds;
    //! [change]
    print("repaired after the change", repaired);
    const UpdateCounts& counts = planner->lastUpdate();
    std::printf(
        "  %zu bricks of the map changed: %zu vertices and %zu edges gone, %zu vertices new\n",
        change.bricks().size(), counts.verticesInvalidated, counts.edgesInvalidated,
        counts.verticesAdded);

    //! [scratch]
    PlanningProblem anew(config, world);
    const auto other = anew.makePlanner("belief_rrt_star");
    other->moveRoot(here.get(), other->model().root(here.get()));
    print("from scratch", solve(*other));
    //! [scratch]
}
