// SPDX-License-Identifier: BSD-3-Clause
// Many independent runs as a list of items: its shards, and the threads that work on it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "config/config.hpp"

namespace photonav {

/// Part `index` of `count`, counted from 1: every count-th item of a list.
struct Shard {
    unsigned index = 1;
    unsigned count = 1;
    bool operator==(const Shard&) const = default;
};

/// Reads "k/n". @throws InputError naming --shard unless 1 <= k <= n
Shard parseShard(const std::string& text);

std::string toString(const Shard& shard);

/// The items of one shard.
template <typename Item>
std::vector<Item> itemsOf(const Shard& shard, const std::vector<Item>& items) {
    std::vector<Item> chosen;
    for (std::size_t i = shard.index - 1; i < items.size(); i += shard.count) {
        chosen.push_back(items[i]);
    }
    return chosen;
}

/// @throws InputError unless there are `runs` seeds from the config's on
void checkSeeds(const Config& config, unsigned runs);

/// Calls work(0), work(1), ... work(count - 1) on `jobs` threads. They begin in this order, however
/// many threads there are.
/// @param work returns false where no further calls shall begin on its thread
/// @throws what a call threw first
void workInOrder(std::size_t count, unsigned jobs, const std::function<bool(std::size_t)>& work);

}  // namespace photonav
