// SPDX-License-Identifier: BSD-3-Clause
// `photonav info`: the information of views, and of the pixels of one view.
#pragma once

#include <optional>

#include "shared/command_io.hpp"

namespace photonav {

struct InfoOptions : CommandOptions {
    std::optional<double> height;   ///< of the heat map [m]; default: the start's
    std::optional<int> cells;       ///< along the longer side of the area; default: 100
    std::optional<std::string> at;  ///< x,y,z[,yaw] of the single view; default: the start,
                                    ///< and without yaw the start's heading
};

/// Heat maps of the information of a view and of the position uncertainty it leaves, and one view
/// with the contribution of its pixels per direction. Writes result.json, config.yaml,
/// information.png, uncertainty.png, view.png, contribution.png, contribution_<direction>.png,
/// report.json and report.html.
/// @return the exit code
/// @throws InputError for bad input, before anything is written
int runInfo(const InfoOptions& options);

}  // namespace photonav
