// SPDX-License-Identifier: BSD-3-Clause
// Exports a result folder as an MCAP file for Foxglove.
#pragma once

#include <filesystem>
#include <string>

namespace photonav {

struct McapExport {
    std::string content;  ///< content of the MCAP file
    std::size_t messages = 0;
    double duration = 0.;  ///< time from the first to the last message [s]
};

/// Exports map and scene, paths with their beliefs, and poses over time; for an exploration also
/// its plans, the cells of its map and its images. Times are those of the flight or recording; a
/// plan has no times and is played at 1 m/s.
/// @param report content of the folder's report.json
/// @throws InputError for a damaged folder
McapExport exportMcap(const std::filesystem::path& folder, const std::string& report);

}  // namespace photonav
