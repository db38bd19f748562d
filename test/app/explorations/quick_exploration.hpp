// SPDX-License-Identifier: BSD-3-Clause
// An exploration that takes a fraction of a second.
#pragma once

#include <string>

namespace photonav {

/// Options of `photonav explore`: a small image, coarse views, few vertices and a short way.
inline const std::string kShortExploration =
    " --set camera.width=94 --set camera.height=60 --set planner.view_pitch=0.5"
    " --vertices 100 --shortcut 20 --set goal=[1,2,2] ";
/// The same in a map of large cells.
inline const std::string kQuickExploration = kShortExploration + "--resolution 0.1 ";

}  // namespace photonav
