// SPDX-License-Identifier: BSD-3-Clause
// Lists of a sweep as they are typed, in place of the config's.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace photonav {

struct SweepLists {
    std::optional<std::string> alphas;    ///< "first:last:step" or "a,b,c"
    std::optional<std::string> planners;  ///< "a,b,c"
    std::optional<unsigned> runs;         ///< seeds
    std::optional<std::string> seed;      ///< the first one

    /// These after the overrides given, as --set would take them.
    /// @throws InputError for alphas that are no list
    std::vector<std::string> after(std::vector<std::string> overrides) const;
};

}  // namespace photonav
