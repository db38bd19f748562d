// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/time_order.hpp"

#include <algorithm>

namespace photonav {

/// Patience sorting from the end, so that of rows that exclude each other the first is kept.
std::vector<bool> inOrderOfTime(const std::vector<double>& timestamps, Repeats repeats) {
    const std::size_t count = timestamps.size();
    const auto isBefore = [&](std::size_t i, double t) {
        return repeats == Repeats::kept ? timestamps[i] >= t : timestamps[i] > t;
    };
    std::vector<std::size_t> heads;        // [n]: the latest row that n rows can follow
    std::vector<std::size_t> next(count);  // the row kept after each
    for (std::size_t i = count; i-- > 0;) {
        const auto place = std::lower_bound(heads.begin(), heads.end(), timestamps[i], isBefore);
        next[i] = place == heads.begin() ? count : *(place - 1);
        if (place == heads.end()) {
            heads.push_back(i);
        } else {
            *place = i;
        }
    }
    std::vector<bool> kept(count, false);
    for (std::size_t i = heads.empty() ? count : heads.back(); i < count; i = next[i]) {
        kept[i] = true;
    }
    return kept;
}

InputError outOfOrder(const std::vector<TextRow>& rows, const std::vector<double>& timestamps,
                      const std::vector<bool>& kept, std::size_t i) {
    std::size_t before = i;
    while (before > 0 && !kept[before]) --before;
    const bool isAfterAny = before < i && kept[before];
    if (!isAfterAny || timestamps[i] > timestamps[before]) {
        return rows[i].error("timestamp is larger than the one after");
    }
    return rows[i].error(timestamps[i] < timestamps[before]
                             ? "timestamp is smaller than the one before"
                             : "timestamp repeats the one before");
}

}  // namespace photonav
