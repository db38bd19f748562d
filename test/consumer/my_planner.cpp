// A planner of one's own: start, the best of some random places, goal. Its paths are judged by the
// same beliefs as those of every other planner.
//! [planner]
#include <ompl/base/Planner.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <iostream>
#include <limits>
#include <photonav/io/error.hpp>
#include <photonav/problem/planning_problem.hpp>

namespace ob = ompl::base;
using ompl::geometric::PathGeometric;

class OneCorner : public ob::Planner {
  public:
    explicit OneCorner(photonav::PlanningProblem& problem)
        : Planner(problem.spaceInformation(), "one_corner"), problem_(problem) {}

    ob::PlannerStatus solve(const ob::PlannerTerminationCondition& isOver) override {
        const ob::State* start = pis_.nextStart();
        const ob::State* goal = pis_.nextGoal();
        if (start == nullptr || goal == nullptr) return ob::PlannerStatus::INVALID_START;
        const ob::StateSamplerPtr sampler = si_->allocStateSampler();
        ob::ScopedState<> corner(si_);
        double best = std::numeric_limits<double>::infinity();
        while (!isOver) {
            sampler->sampleUniform(corner.get());
            if (!si_->checkMotion(start, corner.get()) || !si_->checkMotion(corner.get(), goal)) {
                continue;  // not free
            }
            auto path = std::make_shared<PathGeometric>(si_);
            for (const ob::State* state : {start, std::as_const(corner).get(), goal}) {
                path->append(state);
            }
            const double cost = problem_.evaluate(getName(), *path).cost;
            if (cost >= best) continue;
            best = cost;
            pdef_->clearSolutionPaths();
            pdef_->addSolutionPath(path);
        }
        return pdef_->hasSolution() ? ob::PlannerStatus::EXACT_SOLUTION
                                    : ob::PlannerStatus::TIMEOUT;
    }

  private:
    photonav::PlanningProblem& problem_;
};
//! [planner]

//! [main]
int main(int argc, char** argv) {
    if (argc < 2) return 2;
    try {
        const auto config = photonav::loadConfig(argv[1], {argv + 2, argv + argc});
        const photonav::World world(config);
        photonav::PlanningProblem problem(config, world);
        OneCorner planner(problem);
        planner.setProblemDefinition(problem.definition());
        ob::IterationTerminationCondition samples(100);
        if (!planner.solve(samples)) return 1;
        auto& path = *planner.getProblemDefinition()->getSolutionPath()->as<PathGeometric>();
        const photonav::EvaluatedPath mine = problem.evaluate("one_corner", path);
        const photonav::PlanOutcome shortest = problem.solve("rrt_star");
        std::cout << "J " << mine.cost << " at " << mine.length << " m; rrt_star: J "
                  << shortest.path->cost << " at " << shortest.path->length << " m\n";
        return mine.cost < shortest.path->cost ? 0 : 1;
    } catch (const photonav::InputError& error) {
        std::cerr << error.what() << '\n';
        return 2;
    }
}
//! [main]
