// SPDX-License-Identifier: BSD-3-Clause
// Rows of a table in order of time, also where timestamps repeat or go back.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "io/text_table.hpp"

namespace photonav {

enum class Repeats { kept, skipped };

/// Which of the timestamps to keep so that they never decrease (nor repeat): the longest such
/// subsequence, so that one wild timestamp costs one row, whichever way it is off.
std::vector<bool> inOrderOfTime(const std::vector<double>& timestamps, Repeats repeats);

/// "line N: timestamp is ..." of a row that inOrderOfTime() leaves out.
/// @param i the row's
InputError outOfOrder(const std::vector<TextRow>& rows, const std::vector<double>& timestamps,
                      const std::vector<bool>& kept, std::size_t i);

/// Parses rows to items that have a `timestamp`.
/// @param badRows where there is one it gets rows that `parse` throws an InputError for and those
///        out of order, which are passed over; when there are more of them than items, one of them
///        is thrown. Where there is none, the first bad row is thrown, and timestamps may repeat.
template <typename Item>
std::vector<Item> parseInOrderOfTime(const std::vector<TextRow>& rows,
                                     const std::function<Item(const TextRow&)>& parse,
                                     Repeats repeats, std::vector<InputError>* badRows) {
    std::vector<TextRow> goodRows;
    std::vector<Item> items;
    std::vector<double> timestamps;
    for (const TextRow& row : rows) {
        try {
            items.push_back(parse(row));
            timestamps.push_back(items.back().timestamp);
            goodRows.push_back(row);
        } catch (const InputError& error) {
            if (!badRows) throw;
            badRows->push_back(error);
        }
    }
    const auto kept = inOrderOfTime(timestamps, badRows ? repeats : Repeats::kept);
    std::vector<Item> ordered;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (kept[i]) {
            ordered.push_back(std::move(items[i]));
            continue;
        }
        const InputError error = outOfOrder(goodRows, timestamps, kept, i);
        if (!badRows) throw error;
        badRows->push_back(error);
    }
    if (badRows && badRows->size() > ordered.size()) throw badRows->front();
    return ordered;
}

}  // namespace photonav
