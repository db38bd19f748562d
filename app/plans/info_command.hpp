// SPDX-License-Identifier: BSD-3-Clause
// `photonav info`: shows the information of views, and of the pixels of one view.
#pragma once

#include <atomic>
#include <optional>

#include "shared/command_io.hpp"

namespace photonav {

struct InfoOptions : CommandOptions {
    std::optional<double> height;   ///< height of the body in the heat maps [m]; none: the start's
    std::optional<int> cells;       ///< cells along the longer side of the heat maps; none: 100
    std::optional<std::string> at;  ///< place of the single view, "x,y,z[,yaw]" [m, rad]; none: the
                                    ///< start; without yaw: the start's heading
};

/// Draws heat maps of the information of a view and of the position uncertainty after it, and one
/// view with the contributions of its pixels, in total and per direction. Writes result.json,
/// config.yaml, information.png, uncertainty.png, view.png, contribution.png,
/// contribution_<direction>.png, report.json and report.html.
/// @return the exit code: kDone
/// @throws InputError for bad input, before anything is written
int runInfo(const InfoOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
