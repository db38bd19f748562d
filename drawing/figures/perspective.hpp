// SPDX-License-Identifier: BSD-3-Clause
// Perspective views of a world with paths.
#pragma once

#include "photometry/view.hpp"
#include "plot/figure.hpp"
#include "shapes/paths.hpp"

namespace photonav {

struct Perspective {
    std::string title;
    Eigen::AlignedBox3d box;  ///< part of the world that the picture shows, world frame [m]
    std::vector<DrawnPath> paths;
};

/// The box, seen from above its corner of least x and y, with axes along its floor. Paths are drawn
/// with their shadows on the surfaces below; hidden parts of a path are thin. The inside of rooms
/// is seen in views that leave out ceilings and near walls, see cutawayViews().
Figure perspectiveFigure(const ViewSource& world, const Perspective& perspective);

}  // namespace photonav
