// SPDX-License-Identifier: BSD-3-Clause
// Brings the rows of a table into increasing order of time if timestamps repeat or go back.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "io/text_table.hpp"

namespace photonav {

enum class Repeats { kept, skipped };

/// Which of the timestamps to keep so that they never decrease (nor repeat): the longest such
/// subsequence, so that one outlier among the timestamps costs one row only, whether it is too
/// large or too small.
std::vector<bool> inOrderOfTime(const std::vector<double>& timestamps, Repeats repeats);

/// The error "line N: timestamp is ..." for a row that inOrderOfTime() leaves out.
/// @param i index of the row
InputError outOfOrder(const std::vector<TextRow>& rows, const std::vector<double>& timestamps,
                      const std::vector<bool>& kept, std::size_t i);

/// Parses rows into items that have a member `timestamp` [s].
/// @param badRows if given, rows for which `parse` throws an InputError, and rows out of order, are
///         skipped and their errors appended to it. If more rows are skipped than kept, the first
///         of these errors is thrown. If null, the first bad row throws, and timestamps may repeat.
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
