// SPDX-License-Identifier: BSD-3-Clause
// Tests whether a path lies inside a folder.
#pragma once

#include <filesystem>

#include "io/folder_transaction.hpp"

namespace photonav {

/// Whether a path is a given folder or lies inside it, with links resolved.
inline bool isInside(const std::filesystem::path& path, const std::filesystem::path& folder) {
    const auto way = resolvedFolder(path).lexically_relative(resolvedFolder(folder));
    return !way.empty() && *way.begin() != "..";
}

}  // namespace photonav
