// SPDX-License-Identifier: BSD-3-Clause
// Many independent runs as a list of items, divided into shards and worked on by several threads.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "config/config.hpp"

namespace photonav {

/// Part `index` (from 1) of `count` parts of a list: every count-th item, from item `index` on.
struct Shard {
    unsigned index = 1;
    unsigned count = 1;
    bool operator==(const Shard&) const = default;
};

/// Parses "k/n". @throws InputError naming --shard unless 1 <= k <= n
Shard parseShard(const std::string& text);

/// "k/n".
std::string toString(const Shard& shard);

[[noreturn]] void refuseEmptyShard(const Shard& shard, std::size_t items);

/// The items of one shard, in their order.
/// @throws InputError naming --shard for a shard without items
template <typename Item>
std::vector<Item> itemsOf(const Shard& shard, const std::vector<Item>& items) {
    if (shard.index > items.size()) refuseEmptyShard(shard, items.size());
    std::vector<Item> chosen;
    for (std::size_t i = shard.index - 1; i < items.size(); i += shard.count) {
        chosen.push_back(items[i]);
    }
    return chosen;
}

/// Checks that seed, seed + 1, ... are valid seeds for a number of runs.
/// @throws InputError if they exceed the largest 32-bit number
void checkSeeds(const Config& config, unsigned runs);

/// Calls work(0), work(1), ... work(count - 1) on `jobs` threads. The calls begin in this order,
/// whatever the number of threads.
/// @param work returns false if its thread shall begin no further calls
/// @throws the first exception that a call throws
void workInOrder(std::size_t count, unsigned jobs, const std::function<bool(std::size_t)>& work);

}  // namespace photonav
