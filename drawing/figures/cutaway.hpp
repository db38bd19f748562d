// SPDX-License-Identifier: BSD-3-Clause
// Views into rooms from outside.
#pragma once

#include <memory>

#include "problem/world.hpp"

namespace photonav {

/// Renders a world without the surfaces that hide the inside of a box from an eye far above its
/// corner of least x and y: surfaces above the box, like ceilings, and surfaces beyond its sides of
/// least x and y, like the near walls. The floor stays on all sides. Solids that are cut have a
/// dark section. Unknown cells of a map are free.
std::unique_ptr<ViewSource> cutawayViews(const World& world, const Eigen::AlignedBox3d& inside);

}  // namespace photonav
