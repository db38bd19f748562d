// SPDX-License-Identifier: BSD-3-Clause
// A textured octree laid out for rays: a dense snapshot that VoxelRenderer marches through.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "textured_octree.hpp"

namespace photonav {

/// Grey values of 4 x 4 coplanar cell faces and of the faces around them, ready for bilinear
/// interpolation: entry 6 * (q + 1) + p + 1 belongs to the face at (p, q), -1 <= p, q <= 4.
struct FacePatch {
    static constexpr int kSide = 6;
    static constexpr int kValidIndex = kSide * kSide;  ///< of `valid`, in 16-bit words

    std::array<std::uint16_t, kValidIndex> grey{};  ///< 65535 is white
    std::uint16_t valid = 0;                        ///< bit 4 * q + p: the face knows its grey
    std::array<std::uint16_t, 3> unused{};          ///< 80 bytes; also lets one read past valid
};

/// Cells of the map's bounding box and a border of one cell, x fastest, counted from the first
/// border cell.
struct VoxelGrid {
    static constexpr int kPatchesPerBrick = 6 * 4;  ///< face, then layer along its normal

    double resolution = 1.;                             ///< [m]
    Eigen::Array3i first = Eigen::Array3i::Zero();      ///< world index of cell (0, 0, 0)
    Eigen::Array3i size = Eigen::Array3i::Constant(2);  ///< cells, border included
    Eigen::Array3i bricks = Eigen::Array3i::Zero();     ///< bricks of 4 x 4 x 4 cells

    /// Cells to the nearest cell that ends a ray, in the maximum norm: all cells closer than that
    /// are empty. 0: this cell ends rays. Four bytes are readable at every cell.
    std::vector<std::uint8_t> distance;

    /// Textures of a brick: entry brickTextures[brick] * kPatchesPerBrick + 4 * face + layer of
    /// patchOf is an index into patches. Brick textures 0 and patch 0 are empty.
    std::vector<std::int32_t> brickTextures;
    std::vector<std::int32_t> patchOf;
    std::vector<FacePatch> patches;

    /// @throws std::invalid_argument when the map's bounding box has more than 2^31 cells
    VoxelGrid(const TexturedOcTree& map, UnknownPolicy unknown);

    std::size_t brickIndex(int x, int y, int z) const {
        return (std::size_t(z >> 2) * bricks.y() + (y >> 2)) * bricks.x() + (x >> 2);
    }
};

}  // namespace photonav
