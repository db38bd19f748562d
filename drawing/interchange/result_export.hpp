// SPDX-License-Identifier: BSD-3-Clause
// A result folder as an MCAP file, to be watched in Foxglove.
#pragma once

#include <filesystem>
#include <string>

namespace photonav {

struct McapExport {
    std::string content;  ///< of the file
    std::size_t messages = 0;
    double duration = 0.;  ///< from the first to the last [s]
};

/// Map and scene, paths with their beliefs, and poses in time; of an exploration its plans, cells
/// and images as well. Times are those of the flight or of the recording; a plan is flown at a
/// metre a second.
/// @param report content of the folder's report.json
/// @throws InputError for a folder that is damaged
McapExport exportMcap(const std::filesystem::path& folder, const std::string& report);

}  // namespace photonav
