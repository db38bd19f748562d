// SPDX-License-Identifier: BSD-3-Clause
// A sweep as a list of independent runs, cut into shards, and what makes two sweeps the same.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "config/config.hpp"

namespace photonav {

/// One run of a sweep.
struct SweepItem {
    std::string planner;
    double alpha = 0.;
    std::uint32_t seed = 1;
    auto operator<=>(const SweepItem&) const = default;
};

/// @throws InputError unless there are `runs` seeds from the config's on
void checkSeeds(const Config& config, unsigned runs);

/// All runs that a config asks for: planner by planner, alpha by alpha, seed by seed.
std::vector<SweepItem> sweepItems(const Config& config);

/// Part `index` of `count`, counted from 1: every count-th run of a sweep.
struct SweepShard {
    unsigned index = 1;
    unsigned count = 1;
    bool operator==(const SweepShard&) const = default;
};

/// Reads "k/n". @throws InputError naming --shard unless 1 <= k <= n
SweepShard parseShard(const std::string& text);

std::string toString(const SweepShard& shard);

/// The runs of one shard.
std::vector<SweepItem> itemsOf(const SweepShard& shard, const std::vector<SweepItem>& items);

/// Everything that the results of a sweep depend on, by dotted key: the config without what the
/// sweep sets itself or only compares with, the contents of the scene or map and of the textures,
/// buffers and materials it is made of (whose folder does not matter), the program's version.
using SweepIdentity = std::map<std::string, std::string>;

SweepIdentity sweepIdentity(const Config& config);

/// What a single run depends on: the same without the keys that choose which runs there are.
SweepIdentity runIdentity(SweepIdentity identity);

/// The first key that differs, as "planner.vertices: 300 instead of 2500"; empty when none does.
std::string difference(const SweepIdentity& found, const SweepIdentity& expected);

}  // namespace photonav
