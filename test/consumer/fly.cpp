//! [fly]
#include <iostream>
#include <photonav/flight/flight_setup.hpp>
#include <photonav/io/error.hpp>

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    try {
        const auto config = photonav::loadConfig(argv[1], {argv + 2, argv + argc});
        const photonav::World world(config);
        photonav::PlanningProblem problem(config, world);
        const photonav::PlanOutcome plan = problem.solve(config.planner);
        std::cout << problem.statusOf(plan) << '\n';
        if (!plan.isSolved()) return 1;
        const photonav::FlightSetup setup = photonav::setUpFlight(problem);
        const photonav::FlightResult flight =
            fly(photonav::plannedViews(plan.path->points), setup.world, setup.options);
        std::cout << nameOf(flight.end) << " after " << flight.duration << " s\n";
        return flight.end == photonav::FlightEnd::arrived ? 0 : 1;
    } catch (const photonav::InputError& error) {
        std::cerr << error.what() << '\n';
        return 2;
    }
}
//! [fly]
