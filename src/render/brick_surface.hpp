// SPDX-License-Identifier: BSD-3-Clause
// The faces of the cells of one brick, and the patches of texture for interpolation along rays.
#pragma once

#include <array>
#include <cstdint>

#include "map/textured_octree.hpp"
#include "render/voxel_grid.hpp"

namespace photonav {

/// The surface in a brick of 4 x 4 x 4 cells. Cell (x, y, z) has bit x + 4 y + 16 z in the masks
/// and the same index in the arrays.
struct BrickSurface {
    std::uint64_t occupied = 0;
    std::uint64_t known = 0;                 ///< occupied cells of which a face was observed
    std::array<std::uint64_t, 6> exposed{};  ///< by face: known cells whose face views may show
    std::array<std::array<std::uint16_t, 64>, 6> grey{};   ///< by face: ShownGreys of known cells
    std::array<std::array<std::uint8_t, 64>, 6> weight{};  ///< by face: ShownWeights
    std::array<ShownSurfaces, 64> inside{};                ///< surfaces inside known cells

    /// Whether two bricks are equal except for `exposed`.
    bool hasSameCells(const BrickSurface& other) const {
        return occupied == other.occupied && known == other.known && grey == other.grey &&
               weight == other.weight && inside == other.inside;
    }
};

/// A brick (in the middle) and its 26 neighbours, x fastest; an empty BrickSurface stands for a
/// brick without a surface.
using SurfaceNeighbours = std::array<const BrickSurface*, 27>;

/// By face: the known cells of the middle brick whose face is exposed, because no occupied cell
/// covers the face or because a surface inside the cell points to it.
std::array<std::uint64_t, 6> exposedFaces(const SurfaceNeighbours& neighbours);

/// The exposed faces in one layer of a brick, as FacePatch::valid.
/// @param layer coordinate of the layer along the normal of the face, 0 to 3
std::uint16_t exposedInLayer(const BrickSurface& surface, int face, int layer);

/// Grey values of the faces in one layer of the middle brick and around it.
/// @param layer coordinate of the layer along the normal of the face, 0 to 3
/// @param valid exposedInLayer() of the middle brick
FacePatch makePatch(const SurfaceNeighbours& neighbours, int face, int layer, std::uint16_t valid);

}  // namespace photonav
