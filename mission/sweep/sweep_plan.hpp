// SPDX-License-Identifier: BSD-3-Clause
// A sweep as a list of independent runs, and the identity by which sweeps are compared.
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "runs/identity.hpp"
#include "runs/work_items.hpp"

namespace photonav {

/// One run of a sweep.
struct SweepItem {
    std::string planner;
    double alpha = 0.;
    std::uint32_t seed = 1;
    auto operator<=>(const SweepItem&) const = default;
};

/// "rrt_star alpha 0.5 seed 3"
std::string nameOf(const SweepItem& item);

/// All runs of a config's sweep: ordered by planner, then alpha, then seed, each in the order of
/// the config.
std::vector<SweepItem> sweepItems(const Config& config);

/// Everything that the results of a sweep depend on: identityOf() the config without the keys that
/// the sweep sets itself, without published values and references, and without the sections of
/// other commands.
Identity sweepIdentity(const Config& config);

/// Everything that the result of a single run depends on: the sweep's identity without the keys
/// that choose the runs (seed and the section `sweep`).
Identity runIdentity(const Identity& sweep);

}  // namespace photonav
