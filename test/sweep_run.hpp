// SPDX-License-Identifier: BSD-3-Clause
// A run of a sweep that did not take place.
#pragma once

#include <limits>

#include "sweep/sweep_runs.hpp"

namespace photonav::test {

inline SweepRun makeRun(const SweepItem& item, double cost, double length, double meanTrace) {
    SweepRun run{item, cost, length, meanTrace, 0.5 * meanTrace, 100, 40, 0.25, "done", {}};
    run.path = {{{0., 0., 2.}, 0.}, {{length, 0., 2.}, 0.5}};
    return run;
}

/// Two planners and RRT*, the first with a run that found no path, and a row of a publication.
struct SampleSweep {
    SweepConfig config;
    std::vector<SweepRun> runs;

    SampleSweep() {
        config.planners = {"pa_rrt_star", "belief_rrt_star", "rrt_star"};
        config.alphas = {0.05, 0.15};
        config.paper = {{0.15, 40.45, 7.75, 9.25}};
        const double none = std::numeric_limits<double>::quiet_NaN();
        SweepRun lost = makeRun({"pa_rrt_star", 0.15, 2}, none, none, none);
        lost.goalTrace = none;
        lost.status = "no path";
        runs = {makeRun({"pa_rrt_star", 0.15, 1}, 3., 10., 0.2), lost,
                makeRun({"belief_rrt_star", 0.05, 1}, 5., 11., 0.3),
                makeRun({"belief_rrt_star", 0.05, 2}, 7., 13., 0.1),
                makeRun({"rrt_star", 0.15, 1}, 9., 8., 0.4)};
    }
};

}  // namespace photonav::test
