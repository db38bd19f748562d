// SPDX-License-Identifier: BSD-3-Clause
// Planning online in the labyrinth, 27 x 10 x 2.5 m: the first plan, and per keyframe the time from
// the image to the check of the present way and to the new plan, compared with plans from scratch
// in the same maps. One thread, processor time. The camera of the robot looks down at 45 degrees,
// its heading is free. Depth and images are noisy, poses are exact. Paths are ranked by quick views
// or, to compare, by whole ones; J is always that of whole views at exact poses, which are not part
// of the times unless the planner asks for them.
#include <fmt/format.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Console.h>

#include <random>

#include "bench_arguments.hpp"
#include "geometry/se3.hpp"
#include "image_noise.hpp"
#include "map/map_fusion.hpp"
#include "problem/planning_problem.hpp"
#include "render/mesh_renderer.hpp"
#include "statistics.hpp"
#include "thread_time.hpp"

using namespace photonav;
namespace ob = ompl::base;

namespace {

constexpr double kStep = 0.5;          // flown between keyframes [m]
constexpr int kBetweenScratches = 10;  // keyframes

/// The robot's RGB-D camera, simulated in the true scene.
class SimulatedRgbd {
  public:
    SimulatedRgbd(const MeshRenderer& scene, const Config& config)
        : scene_(scene), camera_(config.camera.camera()), T_b_c_(config.camera.T_b_c()) {}

    View render(const Pose& T_w_b, bool isNoisy) {
        View view;
        scene_.render(camera_, poseOf(T_w_b), view);
        addNoise(view, random_, isNoisy ? 1.F : 0.F);
        return view;
    }
    MapChange fuseInto(TexturedOcTree& map, const View& view, const Pose& T_w_b) const {
        return fuse(map, view, camera_, poseOf(T_w_b));
    }

  private:
    Pose poseOf(const Pose& T_w_b) const { return (T_w_b * T_b_c_).inverse(); }

    const MeshRenderer& scene_;
    Camera camera_;
    Pose T_b_c_;
    std::mt19937 random_{1};
};

/// All of the labyrinth as the robot would map it: views all over it, in six directions.
void exploreAll(TexturedOcTree& map, SimulatedRgbd& camera, const World& truth) {
    for (double x = 0.7; x < 26.5; x += 1.5) {
        for (double y = 0.7; y < 9.5; y += 1.5) {
            const Eigen::Vector3d p_w(x, y, 1.3);
            if (truth.clearance(p_w) < 0.25) continue;
            for (int i = 0; i < 6; ++i) {
                const Pose T_w_b = levelPose(p_w, std::numbers::pi / 3 * i);
                camera.fuseInto(map, camera.render(T_w_b, false), T_w_b);
            }
        }
    }
}

/// What all the keyframes took.
struct Times {
    std::vector<double> fuse, world, views, check, root, plan, answer, viewsMarked, viewsRendered;

    void print() const {
        const auto line = [](const char* what, const std::vector<double>& values) {
            fmt::print("  {:34} median {:8.1f}   95 % {:8.1f}   most {:8.1f}\n", what,
                       quantile(values, 0.5), quantile(values, 0.95), quantile(values, 1.));
        };
        line("fuse [ms]", fuse);
        line("clearance and snapshot [ms]", world);
        line("views marked, vertices checked [ms]", views);
        line("image to 'is my way free' [ms]", check);
        line("root moved [ms]", root);
        line("solve [ms]", plan);
        line("update and answer, without fusion [ms]", answer);
        line("views marked", viewsMarked);
        line("views rendered", viewsRendered);
    }
};

struct Plan {
    double milliseconds = 0.;
    double views = 0.;
    double viewMilliseconds = 0.;  ///< by the clock
    double cost = 0.;
};

class Flight {
  public:
    Flight(const Config& config, const std::string& planner, bool isKnown)
        : config_(config),
          truth_(config),
          scene_(*truth_.scene()),
          camera_(scene_, config),
          map_(std::make_shared<TexturedOcTree>(0.05)),
          name_(planner) {
        if (isKnown) exploreAll(*map_, camera_, truth_);
        position_.translation() = config.start.position;
        camera_.fuseInto(*map_, camera_.render(position_, true), position_);
        world_.emplace(std::shared_ptr<const TexturedOcTree>(map_), config);
        problem_.emplace(config, *world_);
    }

    Plan planFirst() {
        planner_ = problem_->makePlanner(name_);
        return solve(*planner_, *problem_);
    }

    /// Of the path that the planner has now.
    double exactCost() const { return exactCost(*planner_, *problem_); }

    /// Along the present path, one keyframe.
    void fly(Times& times) {
        advance();
        const View view = camera_.render(position_, true);
        const InformationField& field = planner_->model().field();
        const double markedBefore = double(field.marked());
        const double viewsBefore = double(field.views() + problem_->evaluator().field().views());
        MapChange change;
        times.fuse.push_back(
            milliseconds([&] { change = camera_.fuseInto(*map_, view, position_); }));
        times.world.push_back(milliseconds([&] { world_->mapChanged(change); }));
        times.views.push_back(milliseconds([&] { problem_->followMap(); }));
        times.check.push_back(times.fuse.back() + times.world.back() + times.views.back());
        times.viewsMarked.push_back(double(field.marked()) - markedBefore);
        keepClear();
        times.root.push_back(milliseconds([&] {
            ob::ScopedState<> state(problem_->spaceInformation());
            problem_->space().setState(state.get(), position_.translation(), yaw_);
            planner_->moveRoot(state.get(), belief_);
        }));
        times.plan.push_back(solve(*planner_, *problem_).milliseconds);
        times.answer.push_back(times.world.back() + times.views.back() + times.root.back() +
                               times.plan.back());
        times.viewsRendered.push_back(
            double(field.views() + problem_->evaluator().field().views()) - viewsBefore);
        const UpdateCounts& counts = planner_->lastUpdate();
        invalidated_ += counts.verticesInvalidated;
        added_ += counts.verticesAdded;
        rewired_ += counts.verticesRewired;
    }

    /// The present problem from the beginning, and the cost of the planner that is kept.
    Plan planFromScratch() {
        Config now = config_;
        PlanningProblem problem(now, *world_);
        const auto planner = problem.makePlanner(name_);
        ob::ScopedState<> state(problem.spaceInformation());
        problem.space().setState(state.get(), position_.translation(), yaw_);
        planner->moveRoot(state.get(), belief_);
        return solve(*planner, problem);
    }

    bool hasArrived() const {
        return (position_.translation() - config_.goal.position).norm() < 0.3;
    }
    void printCounts(int keyframes) const {
        fmt::print("  per keyframe: {:.1f} vertices invalidated, {:.1f} added, {:.1f} rewired\n",
                   double(invalidated_) / keyframes, double(added_) / keyframes,
                   double(rewired_) / keyframes);
    }

  private:
    static Plan solve(BeliefPlanner& planner, PlanningProblem& problem) {
        Plan plan;
        const double views = double(planner.model().field().views());
        const double seconds = planner.model().field().seconds();
        plan.milliseconds = milliseconds(
            [&] { planner.solve(ob::PlannerTerminationCondition([] { return false; })); });
        plan.views = double(planner.model().field().views()) - views;
        plan.viewMilliseconds = 1e3 * (planner.model().field().seconds() - seconds);
        plan.cost = exactCost(planner, problem);
        return plan;
    }

    static double exactCost(BeliefPlanner& planner, const PlanningProblem& problem) {
        const auto solution = planner.getProblemDefinition()->getSolutionPath();
        if (!solution) return std::numeric_limits<double>::quiet_NaN();
        const auto& states = solution->as<ompl::geometric::PathGeometric>()->getStates();
        Config whole = problem.config();
        whole.quickViews = true;  // its evaluator is the exact one
        PlanningProblem judge(whole, problem.world());
        BeliefModel& model = judge.evaluator();
        Belief belief = planner.movedRoot() ? *planner.movedRoot() : model.root(states.front());
        for (std::size_t i = 1; i < states.size(); ++i) {
            Motion motion = model.motion(states[i - 1], states[i]);
            belief = model.propagate(belief, motion);
        }
        return belief.cost;
    }

    /// What was just seen may be nearer than the robot's radius, by noise and by the size of cells:
    /// the robot gives way.
    void keepClear() {
        std::uniform_real_distribution<double> offset(-0.1, 0.1);
        const Eigen::Vector3d before = position_.translation();
        for (int i = 0;
             i < 1000 && world_->clearance(position_.translation()) <= config_.robotRadius; ++i) {
            position_.translation() =
                before + Eigen::Vector3d(offset(random_), offset(random_), offset(random_));
        }
    }

    void advance() {
        const auto path = planner_->getProblemDefinition()->getSolutionPath();
        if (!path) return;
        auto& states = path->as<ompl::geometric::PathGeometric>()->getStates();
        double left = kStep;
        Belief belief = startBelief();
        for (std::size_t i = 1; i < states.size() && left > 0.; ++i) {
            Motion motion = planner_->model().motion(states[i - 1], states[i]);
            const double share = motion.length > left ? left / motion.length : 1.;
            ob::ScopedState<> end(problem_->spaceInformation());
            problem_->spaceInformation()->getStateSpace()->interpolate(states[i - 1], states[i],
                                                                       share, end.get());
            Motion part = planner_->model().motion(states[i - 1], end.get());
            belief = planner_->model().propagate(belief, part);
            position_ = problem_->space().bodyPose(end.get());
            left -= motion.length;
        }
        yaw_ = std::atan2(position_.linear()(1, 0), position_.linear()(0, 0));
        belief.cost = 0.;
        belief_ = belief;
    }
    Belief startBelief() {
        if (planner_->movedRoot()) return *planner_->movedRoot();
        const auto definition = problem_->definition();
        return planner_->model().root(definition->getStartState(0));
    }

    Config config_;
    World truth_;
    MeshRenderer scene_;
    SimulatedRgbd camera_;
    std::shared_ptr<TexturedOcTree> map_;
    std::string name_;
    std::optional<World> world_;
    std::optional<PlanningProblem> problem_;
    std::shared_ptr<BeliefPlanner> planner_;
    Pose position_ = Pose::Identity();
    double yaw_ = 0.;
    Belief belief_;
    std::mt19937 random_{2};
    std::size_t invalidated_ = 0, added_ = 0, rewired_ = 0;
};

void run(const Config& config, const std::string& planner, bool isKnown, int keyframes) {
    Flight flight(config, planner, isKnown);
    const Plan first = flight.planFirst();
    fmt::print("\n{}, {} vertices, {} views, {}\n", planner, config.vertices,
               config.quickViews ? "quick" : "whole",
               isKnown ? "the labyrinth mapped before" : "nothing mapped before");
    fmt::print("  first plan {:.0f} ms, {:.0f} of them for {:.0f} views, J {:.3f}\n",
               first.milliseconds, first.viewMilliseconds, first.views, first.cost);
    std::fflush(stdout);
    Times times;
    std::vector<double> time, views, excess;
    for (int i = 0; i < keyframes && !flight.hasArrived(); ++i) {
        flight.fly(times);
        if (i % kBetweenScratches != kBetweenScratches - 1) continue;
        const Plan scratch = flight.planFromScratch();
        time.push_back(scratch.milliseconds);
        views.push_back(scratch.views);
        excess.push_back(100. * (flight.exactCost() / scratch.cost - 1.));
    }
    fmt::print("  {} keyframes{}\n", times.plan.size(), flight.hasArrived() ? ", arrived" : "");
    times.print();
    flight.printCounts(static_cast<int>(times.plan.size()));
    fmt::print("  from scratch: median {:.0f} ms, {:.0f} views: {:.1f} and {:.1f} times as much\n",
               quantile(time, 0.5), quantile(views, 0.5),
               quantile(time, 0.5) / quantile(times.answer, 0.5),
               quantile(views, 0.5) / std::max(1., quantile(times.viewsRendered, 0.5)));
    fmt::print("  J of the repaired plan above that from scratch: median {:.2f} %, most {:.2f} %\n",
               quantile(excess, 0.5), quantile(excess, 1.));
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(
        argc, argv,
        "online_bench [VERTICES=1000] [KEYFRAMES=60] [PLANNER=belief_rrt_star] [VIEWS=quick|whole] "
        "[LABYRINTH=both|known|unknown]");
    ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
    Config config = loadConfig(PHOTONAV_SOURCE_DIR "/config/labyrinth.yaml");
    config.vertices = arguments.number(1, 1000U, 1U);
    config.unknownToPlanner = UnknownPolicy::free;
    const int keyframes = arguments.number(2, 60);
    const std::string planner = arguments.text(3, "belief_rrt_star");
    config.quickViews = arguments.text(4, "quick") != "whole";
    const std::string labyrinth = arguments.text(5, "both");
    if (labyrinth != "unknown") run(config, planner, true, keyframes);
    if (labyrinth != "known") run(config, planner, false, keyframes);
}
