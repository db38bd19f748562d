// Plans in a map, fuses the image of a wall, and plans around it.
#include <iostream>
#include <photonav/geometry/camera.hpp>
#include <photonav/map/map_fusion.hpp>
#include <photonav/problem/planning_problem.hpp>
#include <photonav/render/mesh_renderer.hpp>

int main() {
    photonav::Config config;
    config.bounds = {Eigen::Vector3d(0., 0., 1.), Eigen::Vector3d(8., 4., 1.)};
    config.start.position = {1., 2., 1.};
    config.goal.position = {7., 2., 1.};
    config.vertices = 300;
    config.unknownToPlanner = photonav::UnknownPolicy::free;
    const auto map = std::make_shared<photonav::TexturedOcTree>(0.1);
    photonav::World world(map, config);
    photonav::PlanningProblem problem(config, world);
    const auto planner = problem.makePlanner("belief_rrt_star");
    const photonav::PlanOutcome before = problem.solve(planner);

    photonav::Scene wall;
    addBox(wall, {4., 1., 0.}, {4.2, 3., 3.}, addTexture(wall, photonav::valueNoise({})));
    const photonav::Camera camera = photonav::makeCamera(94, 60, 1.2);
    photonav::Pose T_w_b = photonav::Pose::Identity();
    T_w_b.translation() = config.start.position;
    const photonav::Pose T_c_w = (T_w_b * photonav::cameraMount(0.)).inverse();
    photonav::View view;
    photonav::MeshRenderer(wall).render(camera, T_c_w, view);
    const photonav::MapChange change = fuse(*map, view, camera, T_c_w);
    world.mapChanged(change);
    problem.followMap();
    const photonav::PlanOutcome after = problem.solve(planner);

    if (!before.isSolved() || !after.isSolved()) return 1;
    std::cout << before.path->length << " m, behind the wall " << after.path->length << " m\n";
    return after.path->length > before.path->length + 0.2 ? 0 : 1;
}
