// SPDX-License-Identifier: BSD-3-Clause
// What a depth filter has come to, pixel by pixel, as pictures.
#pragma once

#include <string>
#include <vector>

#include "depth_filter.hpp"
#include "map_comparison.hpp"

namespace photonav {

/// The reference image; the depths that have converged; which pixels have converged, were given up
/// or are still open; and, where there is any, how far the depths are from the recorded ones.
/// @param recorded depth of the reference [m], 0: not known; of the same size
/// @param caption what the reference is
std::vector<Panel> convergencePanels(const DepthFilter& filter, const ImageF& recorded,
                                     const std::string& caption);

}  // namespace photonav
