// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <ios>
#include <string>
#include <string_view>

#include "io/reading.hpp"

namespace photonav {

/// Whether a file is a regular one that begins with these bytes.
/// @throws InputError for a file without permission to read
inline bool beginsWith(const std::string& file, std::string_view magic) {
    if (!std::filesystem::is_regular_file(file)) return false;
    std::string start(magic.size(), ' ');
    return openToRead(file).read(start.data(), std::ssize(start)) && start == magic;
}

}  // namespace photonav
