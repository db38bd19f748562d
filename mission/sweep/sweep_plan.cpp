// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/sweep_plan.hpp"

#include <fmt/format.h>

namespace photonav {
namespace {

/// Keys that the sweep sets itself, run by run, or that change no run.
const std::set<std::string> kIrrelevant{"planner.name",
                                        "planner.alpha",
                                        "planner.compare_with_rrt_star",
                                        "sweep.paper",
                                        "sweep.paper_trace_unit",
                                        "sweep.reference",
                                        "map.made_by",
                                        "fly.",
                                        "explore."};

}  // namespace

std::string nameOf(const SweepItem& item) {
    return fmt::format("{} alpha {} seed {}", item.planner, item.alpha, item.seed);
}

std::vector<SweepItem> sweepItems(const Config& config) {
    std::vector<SweepItem> items;
    for (const std::string& planner : config.sweep.planners) {
        for (const double alpha : config.sweep.alphas) {
            for (unsigned run = 0; run < config.sweep.runs; ++run) {
                items.push_back({planner, alpha, config.seed + run});
            }
        }
    }
    return items;
}

Identity sweepIdentity(const Config& config) { return without(kIrrelevant, identityOf(config)); }

Identity runIdentity(const Identity& sweep) { return without({"seed", "sweep."}, sweep); }

}  // namespace photonav
