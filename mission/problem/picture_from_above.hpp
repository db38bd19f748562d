// SPDX-License-Identifier: BSD-3-Clause
// The world as a map on paper shows it.
#pragma once

#include <Eigen/Geometry>

#include "photometry/view.hpp"
#include "scene/scene.hpp"

namespace photonav {

/// A picture from above in parallel projection, up to a pixel, grey values in [0, 1]. Image right
/// is x, the first row is at the largest y. Places without surface are white, edges of objects are
/// darkened, and solids from the lower half to the height `top` and beyond are filled with one dark
/// grey, as in a floor plan. A lintel, which is higher, does not close its door.
/// @param area part of the world in x and y [m]
/// @param top only surfaces below this height are shown [m]
/// @param lowest height of the lowest surface [m]
/// @param pixelSize edge of a pixel [m]
/// @param solids of the scene, Scene::solids
ImageF pictureFromAbove(const ViewSource& views, const Eigen::AlignedBox2d& area, double top,
                        double lowest, double pixelSize, const std::vector<Prism>& solids = {});

}  // namespace photonav
