// SPDX-License-Identifier: BSD-3-Clause
// Files that are on the disk when the power fails.
#pragma once

#include <filesystem>
#include <string_view>

namespace photonav {

/// Writes the whole file or nothing, as writeFileAtomically() does, and the new file is on the disk
/// before it replaces the older one. For files outside of a FolderTransaction, which brings all of
/// its own to the disk at once.
/// @throws InputError naming the file and the system's reason
void replaceFile(const std::filesystem::path& file, std::string_view content);

/// Waits until a file, or the names in a folder, are on the disk.
/// @param reported in an error
/// @throws InputError when they cannot be written
void synchronise(const std::filesystem::path& path, const std::filesystem::path& reported);

}  // namespace photonav
