// SPDX-License-Identifier: BSD-3-Clause
// A world in perspective, from above one of its corners, with paths in it.
#pragma once

#include "photometry/view.hpp"
#include "plot/figure.hpp"
#include "shapes/paths.hpp"

namespace photonav {

struct Perspective {
    std::string title;
    Eigen::AlignedBox3d box;  ///< what is to be in the picture, in w [m]
    std::vector<DrawnPath> paths;
};

/// The box seen from above the corner of its least x and y, with axes along its floor; paths with
/// their shadows on what is below them, thinner and pale where something hides them.
Figure perspectiveFigure(const ViewSource& world, const Perspective& perspective);

}  // namespace photonav
