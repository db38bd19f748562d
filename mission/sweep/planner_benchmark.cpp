// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/planner_benchmark.hpp"

#include <fmt/format.h>
#include <ompl/tools/benchmark/Benchmark.h>

#include <filesystem>
#include <locale>
#include <sstream>

#include "geometry/constants.hpp"
#include "io/interrupted.hpp"
#include "io/number.hpp"
#include "problem/planning_problem.hpp"

namespace photonav {
namespace ob = ompl::base;
namespace {

/// Thrown out of OMPL's loop over runs; no std::exception, which it would swallow.
struct LoopLeft {};

/// OMPL's benchmark, with the last value of the progress, which its sampling misses.
class Benchmark : public ompl::tools::Benchmark {
  public:
    using ompl::tools::Benchmark::Benchmark;

    /// Adds to run `run` of planner `planner` a last sample of the progress.
    void addSample(std::size_t planner, std::size_t run,
                   const std::map<std::string, std::string>& sample) {
        auto& runs = exp_.planners.at(planner).runsProgressData;
        if (run < runs.size()) runs[run].push_back(sample);
    }
};

/// One benchmark: the events between OMPL's loop and our planners.
class Session {
  public:
    Session(const Config& config, const World& world, const std::atomic<bool>& interrupted,
            const std::function<void(const SweepItem&)>& onRun)
        : config_(config),
          plan_(config, world),
          interrupted_(interrupted),
          onRun_(onRun),
          setup_(plan_.spaceInformation()),
          benchmark_(setup_, std::filesystem::path(config.file).stem().string()) {
        for (const std::string& name : config.sweep.planners) {
            planners_.push_back(plan_.makePlanner(name));
            planners_.back()->endWhen([this] { return interrupted_.load(); });
            benchmark_.addPlanner(planners_.back());
        }
        const auto definition = planners_.front()->getProblemDefinition();
        setup_.getProblemDefinition()->addStartState(definition->getStartState(0));
        setup_.setGoal(definition->getGoal());
        setup_.setPlanner(planners_.front());
        benchmark_.addExperimentParameter("alpha", "REAL", fmt::format("{}", config.belief.alpha));
        benchmark_.setPreRunEvent([this](const ob::PlannerPtr& planner) { prepare(*planner); });
        benchmark_.setPostRunEvent([this](const ob::PlannerPtr& planner, auto& properties) {
            record(*planner, properties);
        });
    }

    BenchmarkOutcome run(const BenchmarkLimits& limits) {
        constexpr double kMemory = 16384.;  // [MB]
        const ompl::tools::Benchmark::Request request(limits.timeLimit, kMemory, config_.sweep.runs,
                                                      limits.interval, false, false, false);
        for (const auto& planner : planners_) {
            planner->params().setParam("time_limit", fmt::format("{}", limits.timeLimit));
        }
        const InterruptionScope scope = plan_.interruptedBy(interrupted_);
        try {
            benchmark_.benchmark(request);
        } catch (const LoopLeft&) {
        }
        addLastSamples();
        outcome_.curves = curves();
        std::ostringstream log;
        log.imbue(std::locale::classic());
        if (!outcome_.runs.empty()) benchmark_.saveResultsToStream(log);
        outcome_.log = log.str();
        return outcome_;
    }

  private:
    SweepItem item(std::size_t run) const {
        const std::size_t perPlanner = config_.sweep.runs;
        return {config_.sweep.planners[run / perPlanner], config_.belief.alpha,
                config_.seed + static_cast<std::uint32_t>(run % perPlanner)};
    }

    /// Prepares a run from scratch: no cached views, its own seed, goals offered from the first on.
    void prepare(ob::Planner& planner) {
        if (interrupted_) throw LoopLeft();
        const SweepItem next = item(outcome_.runs.size());
        onRun_(next);
        planner.params().setParam("seed", std::to_string(next.seed));
        setup_.setGoal(plan_.definition()->getGoal());
        plan_.forgetViews();
        planner.clear();  // once more: its progress counts the views
    }

    void record(ob::Planner& planner, ompl::tools::Benchmark::RunProperties& properties) {
        const auto& ours = dynamic_cast<const BeliefPlanner&>(planner);
        const bool hasPath = planner.getProblemDefinition()->hasExactSolution();
        if (interrupted_) throw LoopLeft();  // a run that was cut is no measurement
        PlanOutcome noPath;                  // unless one is found below
        noPath.vertices = ours.vertices();
        noPath.iterations = ours.iterations();
        SweepRun run{item(outcome_.runs.size()),
                     kNone,
                     kNone,
                     kNone,
                     kNone,
                     ours.vertices(),
                     ours.model().field().views(),
                     toNumber(properties.at("time REAL")),
                     plan_.statusOf(noPath),
                     {}};
        if (hasPath) setPath(run, evaluated(ours));
        properties["seed INTEGER"] = std::to_string(run.item.seed);
        properties["vertices INTEGER"] = std::to_string(run.vertices);
        properties["views INTEGER"] = std::to_string(run.views);
        std::map<std::string, std::string> sample{{"time REAL", properties.at("time REAL")}};
        for (const auto& [name, value] : planner.getPlannerProgressProperties()) {
            sample[name] = value();
        }
        samples_.push_back(sample);
        if (hasPath) {
            run.status = "done";
            properties["cost REAL"] = fmt::format("{}", run.cost);
            properties["path length REAL"] = fmt::format("{}", run.length);
            properties["mean trace REAL"] = fmt::format("{}", run.meanTrace);
            properties["trace at goal REAL"] = fmt::format("{}", run.goalTrace);
        }
        outcome_.runs.push_back(run);
    }

    EvaluatedPath evaluated(const BeliefPlanner& planner) {
        try {
            return plan_.evaluate(planner);
        } catch (const Interrupted&) {
            throw LoopLeft();
        }
    }

    void addLastSamples() {
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            benchmark_.addSample(i / config_.sweep.runs, i % config_.sweep.runs, samples_[i]);
        }
    }

    std::vector<BenchmarkCurve> curves() const {
        std::vector<BenchmarkCurve> curves;
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            const auto& planner =
                benchmark_.getRecordedExperimentData().planners[i / config_.sweep.runs];
            BenchmarkCurve& curve = curves.emplace_back();
            curve.planner = item(i).planner;
            for (const auto& sample : planner.runsProgressData.at(i % config_.sweep.runs)) {
                curve.seconds.push_back(toNumber(sample.at("time REAL")));
                curve.cost.push_back(toNumber(sample.at("best cost REAL")));
            }
        }
        return curves;
    }

    const Config& config_;
    PlanningProblem plan_;
    const std::atomic<bool>& interrupted_;
    const std::function<void(const SweepItem&)>& onRun_;
    ompl::geometric::SimpleSetup setup_;
    Benchmark benchmark_;
    std::vector<std::shared_ptr<BeliefPlanner>> planners_;
    std::vector<std::map<std::string, std::string>> samples_;  // the last one of each run
    BenchmarkOutcome outcome_;
};

}  // namespace

BenchmarkOutcome benchmarkPlanners(const Config& config, const World& world,
                                   const BenchmarkLimits& limits,
                                   const std::atomic<bool>& interrupted,
                                   const std::function<void(const SweepItem&)>& onRun) {
    return Session(config, world, interrupted, onRun).run(limits);
}

}  // namespace photonav
