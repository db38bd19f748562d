// SPDX-License-Identifier: BSD-3-Clause
// The names in a table.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace photonav {

/// @param name member of an entry
template <class Table, class Name>
std::vector<std::string> namesOf(const Table& table, Name name) {
    std::vector<std::string> names;
    names.reserve(table.size());
    for (const auto& entry : table) names.emplace_back(std::invoke(name, entry));
    return names;
}

}  // namespace photonav
