// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "io/folder_transaction.hpp"

namespace photonav {

/// Whether a path is a folder, or something in it, once links are followed.
inline bool isInside(const std::filesystem::path& path, const std::filesystem::path& folder) {
    const auto way = resolvedFolder(path).lexically_relative(resolvedFolder(folder));
    return !way.empty() && *way.begin() != "..";
}

}  // namespace photonav
