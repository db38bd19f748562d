// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

namespace photonav {

/// Writes the whole file or nothing: into a temporary file beside it, renamed when complete. A
/// reader (or a Ctrl-C) never meets half a file; an older file stays whole until it is replaced.
/// @throws InputError naming the file and the system's reason
void writeFileAtomically(const std::filesystem::path& file, std::string_view content);

}  // namespace photonav
