// SPDX-License-Identifier: BSD-3-Clause
#include "runs/work_items.hpp"

#include <fmt/format.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "io/error.hpp"
#include "io/number.hpp"

namespace photonav {

Shard parseShard(const std::string& text) {
    const std::size_t slash = std::min(text.find('/'), text.size());
    const auto k = numberIn<unsigned>(std::string_view(text).substr(0, slash));
    const auto n =
        numberIn<unsigned>(std::string_view(text).substr(std::min(slash + 1, text.size())));
    if (k && n && *k >= 1 && *k <= *n) return {*k, *n};
    throw InputError("--shard", "",
                     "'" + text + "' is not k/n with k from 1 to n, for example 2/4");
}

std::string toString(const Shard& shard) { return fmt::format("{}/{}", shard.index, shard.count); }

void refuseEmptyShard(const Shard& shard, std::size_t items) {
    throw InputError("--shard", toString(shard), fmt::format("of {} runs none", items));
}

void checkSeeds(const Config& config, unsigned runs) {
    constexpr std::uint64_t kLast = std::numeric_limits<std::uint32_t>::max();
    if (std::uint64_t{config.seed} + runs - 1 <= kLast) return;
    throw config.invalid("seed", fmt::format("{} runs from {} on go beyond the last seed, {}", runs,
                                             config.seed, kLast));
}

void workInOrder(std::size_t count, unsigned jobs, const std::function<bool(std::size_t)>& work) {
    std::atomic<std::size_t> next{0};
    const auto workOn = [&](unsigned) {
        while (!tbb::is_current_task_group_canceling()) {
            const std::size_t i = next++;
            if (i >= count || !work(i)) return;
        }
    };
    const unsigned most = static_cast<unsigned>(tbb::info::default_concurrency());
    const unsigned used = std::min(jobs, most);  // TBB warns of more
    tbb::task_arena threads(static_cast<int>(used));
    threads.execute([&] { tbb::parallel_for(0U, used, 1U, workOn, tbb::simple_partitioner{}); });
}

}  // namespace photonav
