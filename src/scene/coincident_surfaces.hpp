// SPDX-License-Identifier: BSD-3-Clause
// Finds surfaces that coincide, so that it is undefined which of them a renderer shows.
#pragma once

#include "scene/scene.hpp"

namespace photonav {

/// Whether a surface of one scene and a surface of the other overlap in one plane, within a
/// millimetre: for example a poster in the surface of its wall. Surfaces that only touch or cross
/// do not count.
bool haveCoincidentSurfaces(const Scene& a, const Scene& b);

/// The scene without its solids and without the triangles inside or on them. A face of a solid may
/// coincide with another surface, such as the bottom of a box with the floor, but is then not
/// visible.
Scene withoutSolids(const Scene& scene);

}  // namespace photonav
