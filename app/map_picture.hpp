// SPDX-License-Identifier: BSD-3-Clause
// A map drawn as on paper: seen straight from above.
#pragma once

#include "view.hpp"

namespace photonav {

/// Grey values of what lies below `height`, put together from many downward views (nothing above
/// `height` is in the way, such as a ceiling) by their depth; of several views of a place the most
/// vertical one counts.
/// @param area x and y in w [m]
/// @param height z of the cameras in w [m], for example the height of flight
/// @returns about 400 pixels along the longer side; first row at the largest y, first column at the
///          smallest x; 1 (white) where nothing is seen
/// @throws std::invalid_argument if the area is empty
ImageF pictureFromAbove(const ViewSource& map, const Eigen::AlignedBox2d& area, double height);

}  // namespace photonav
