#include <iostream>
#include <photonav/geometry/uncertain_pose.hpp>
#include <photonav/io/error.hpp>
#include <photonav/problem/planning_problem.hpp>
#include <photonav/recording/recording.hpp>

/// Links the planning problem of the installed library; there is no such config here.
bool namesMissingConfig() {
    try {
        const photonav::Config config = photonav::loadConfig("nowhere.yaml");
        const photonav::World world(config);
        return photonav::PlanningProblem(config, world).solve(config.planner).vertices > 0;
    } catch (const photonav::InputError& error) {
        return error.what() == std::string("nowhere.yaml: no such file");
    }
}

int main() {
    photonav::UncertainPose belief;
    belief.covariance.setIdentity();
    const auto moved = photonav::compound(belief, belief, photonav::PropagationOrder::second);
    std::cout << "trace after a step: " << moved.covariance.trace() << '\n';
    const bool isLinked = photonav::parseUp("-y").has_value() && namesMissingConfig();
    return isLinked && moved.covariance.trace() == 12. ? 0 : 1;
}
