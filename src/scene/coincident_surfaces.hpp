// SPDX-License-Identifier: BSD-3-Clause
// Surfaces in one place, of which a renderer shows now the one, now the other.
#pragma once

#include "scene/scene.hpp"

namespace photonav {

/// Whether surfaces of both scenes lie within a millimetre of each other, in one plane: a poster in
/// the surface of its wall. Surfaces that merely touch or cross do not count.
bool haveCoincidentSurfaces(const Scene& a, const Scene& b);

/// The surfaces that are no face of a box or wall full of matter. Such a face may lie in another
/// surface, as a box stands on the floor: nobody sees it.
Scene withoutSolids(const Scene& scene);

}  // namespace photonav
