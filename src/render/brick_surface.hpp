// SPDX-License-Identifier: BSD-3-Clause
// The faces of the cells of one brick, and the patches of texture that rays look up.
#pragma once

#include <array>
#include <cstdint>

#include "map/textured_octree.hpp"
#include "render/voxel_grid.hpp"

namespace photonav {

/// What the map holds of a brick of 4 x 4 x 4 cells. Bit x + 4 y + 16 z of the masks.
struct BrickSurface {
    std::uint64_t occupied = 0;
    std::uint64_t known = 0;                 ///< occupied, and some face of the cell was observed
    std::array<std::uint64_t, 6> exposed{};  ///< known, and views may show this face
    std::array<std::array<std::uint16_t, 64>, 6> grey{};   ///< ShownGreys of known cells, by face
    std::array<std::array<std::uint8_t, 64>, 6> weight{};  ///< ShownWeights of these greys
    std::array<ShownSurfaces, 64> inside{};  ///< of known cells: where the surface lies in them

    bool hasSameCells(const BrickSurface& other) const {
        return occupied == other.occupied && known == other.known && grey == other.grey &&
               weight == other.weight && inside == other.inside;
    }
};

/// A brick and its 26 neighbours, x fastest; a brick without a surface is represented by an empty
/// one.
using SurfaceNeighbours = std::array<const BrickSurface*, 27>;

/// The faces of a brick's known cells, by face, that no occupied cell covers or that a surface
/// inside the cell points to.
std::array<std::uint64_t, 6> exposedFaces(const SurfaceNeighbours& neighbours);

/// Which faces of one layer of a brick are exposed, as FacePatch::valid.
std::uint16_t exposedInLayer(const BrickSurface& surface, int face, int layer);

/// Grey values of one layer of the middle brick and around it.
FacePatch makePatch(const SurfaceNeighbours& neighbours, int face, int layer, std::uint16_t valid);

}  // namespace photonav
