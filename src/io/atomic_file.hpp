// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string_view>

namespace photonav {

/// Writes the whole file or nothing: into a temporary file beside it, renamed when complete. A
/// reader (or a Ctrl-C) never meets half a file; an older file stays whole until it is replaced.
/// Several writers of one file, threads or processes, have a temporary file each: the last one to
/// finish wins.
/// @throws InputError naming the file and the system's reason
void writeFileAtomically(const std::filesystem::path& file, std::string_view content);

/// As above, for content that is written to a stream piece by piece. When `write` throws, nothing
/// is left behind.
void writeFileAtomically(const std::filesystem::path& file,
                         const std::function<void(std::ostream&)>& write);

}  // namespace photonav
