// SPDX-License-Identifier: BSD-3-Clause
// Lists the names of a table's entries.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace photonav {

/// The names of all entries of a table, in its order.
/// @param name pointer to the member of an entry, or to its member function, that gives the name
template <class Table, class Name>
std::vector<std::string> namesOf(const Table& table, Name name) {
    std::vector<std::string> names;
    names.reserve(table.size());
    for (const auto& entry : table) names.emplace_back(std::invoke(name, entry));
    return names;
}

}  // namespace photonav
