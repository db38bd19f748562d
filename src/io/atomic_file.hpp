// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string_view>

namespace photonav {

/// Writes the whole file or nothing. The content goes into a temporary file in the same folder,
/// which is renamed when it is complete. A reader never finds half a file, also after Ctrl-C; an
/// older file stays unchanged until it is replaced. If several threads or processes write the same
/// file, each has its own temporary file, and the last one to finish wins. The file that a link
/// leads to is replaced, not the link.
/// @throws InputError naming the file and the system's reason; for a folder, a pipe or a device
void writeFileAtomically(const std::filesystem::path& file, std::string_view content);

/// As above, for content that is written to a stream piece by piece. When `write` throws, nothing
/// is left behind.
void writeFileAtomically(const std::filesystem::path& file,
                         const std::function<void(std::ostream&)>& write);

/// Whether a file is a temporary one of writeFileAtomically(), which stays where the program is
/// killed while it writes.
bool isTemporaryFile(const std::filesystem::path& file);

}  // namespace photonav
