// SPDX-License-Identifier: BSD-3-Clause
// `photonav export`: a result for other programs to show.
#pragma once

#include <filesystem>

namespace photonav {

/// Writes an MCAP file of a result folder; empty `file`: beside it, called as it is.
/// @return the exit code
/// @throws InputError for a folder that is no result, and a file that cannot be written
int runExport(std::filesystem::path folder, std::filesystem::path file, bool quiet);

}  // namespace photonav
