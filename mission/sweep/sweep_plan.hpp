// SPDX-License-Identifier: BSD-3-Clause
// A sweep as a list of independent runs, and what makes two sweeps the same.
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

/// All runs that a config asks for: planner by planner, alpha by alpha, seed by seed.
std::vector<SweepItem> sweepItems(const Config& config);

/// Everything that the results of a sweep depend on: identityOf() the config without what the sweep
/// sets itself or only compares with, and without the sections of other commands.
Identity sweepIdentity(const Config& config);

/// What a single run depends on: the same without the keys that choose which runs there are.
Identity runIdentity(const Identity& sweep);

}  // namespace photonav
