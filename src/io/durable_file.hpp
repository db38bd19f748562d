// SPDX-License-Identifier: BSD-3-Clause
// Writes files durably: they are on the disk even if the power fails afterwards.
#pragma once

#include <filesystem>
#include <string_view>

namespace photonav {

/// Writes the whole file or nothing, as writeFileAtomically() does. The new file is on the disk
/// before it replaces the older one. For files outside a FolderTransaction, which synchronises all
/// of its files together.
/// @throws InputError naming the file and the system's reason
void replaceFile(const std::filesystem::path& file, std::string_view content);

/// Waits until a file, or the entries of a folder, are on the disk.
/// @param reported path that errors name
/// @throws InputError when they cannot be written
void synchronise(const std::filesystem::path& path, const std::filesystem::path& reported);

}  // namespace photonav
