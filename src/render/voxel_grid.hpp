// SPDX-License-Identifier: BSD-3-Clause
// A dense snapshot of a textured octree, through which VoxelRenderer traces rays.
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "map/textured_octree.hpp"

namespace photonav {

/// A map has more cells in its bounding box than a snapshot can hold.
class MapTooLarge : public std::invalid_argument {
  public:
    using std::invalid_argument::invalid_argument;
};

/// Grey values of 4 x 4 coplanar cell faces and of the faces around them, for bilinear
/// interpolation: entry 6 * (q + 1) + p + 1 belongs to the face at (p, q), -1 <= p, q <= 4.
struct FacePatch {
    static constexpr int kSide = 6;
    static constexpr int kValidIndex = kSide * kSide;  ///< index of `valid` in 16-bit words

    std::array<std::uint16_t, kValidIndex> grey{};  ///< 65535 is white
    std::uint16_t valid = 0;                        ///< bit 4 * q + p: the face has a grey value
    std::array<std::uint16_t, 3> unused{};  ///< pads to 80 bytes; reads past `valid` stay inside
};

/// A box of cells (or of bricks) from `low` up to, not including, `high`.
struct CellBox {
    Eigen::Array3i low = Eigen::Array3i::Zero();
    Eigen::Array3i high = Eigen::Array3i::Zero();

    bool empty() const { return (low >= high).any(); }
    bool operator==(const CellBox& other) const {
        return (low == other.low).all() && (high == other.high).all();
    }
    bool contains(const CellBox& other) const {
        return (other.low >= low).all() && (other.high <= high).all();
    }
    CellBox grown(int cells) const { return {low - cells, high + cells}; }
    CellBox clippedTo(const CellBox& other) const {
        return {low.max(other.low), high.min(other.high)};
    }
    void extend(const CellBox& other) {
        if (other.empty()) return;
        *this = empty() ? other : CellBox{low.min(other.low), high.max(other.high)};
    }
};

/// A box of cells that do not end rays, stored with a brick that contains some of them.
struct EmptyBox {
    /// Largest distance from the brick's first cell to an end of the box [cells].
    static constexpr int kFurthest = 252;

    std::array<std::uint8_t, 3> before{};  ///< 3 + number of cells before the brick's first cell
    std::uint8_t restEnds = 0;  ///< 128 if all cells of the brick outside the box end rays
    std::array<std::uint8_t, 3> after{};  ///< cells from the brick's first one to the box's end
    std::uint8_t unused = 0;              ///< pads to 8 bytes, which rays read as two words
};

/// Whole bricks of 4 x 4 x 4 cells that contain the map's bounding box and a border of at least one
/// cell, x fastest, relative to `first`. Plain data; VoxelGridBuilder fills and updates it.
struct VoxelGrid {
    static constexpr int kPatchesPerBrick = 6 * 4;  ///< 6 faces x 4 layers along their normals

    double resolution = 1.;                          ///< edge of a cell [m]
    Eigen::Array3i first = Eigen::Array3i::Zero();   ///< world index of cell (0, 0, 0)
    Eigen::Array3i size = Eigen::Array3i::Zero();    ///< number of cells stored, multiples of 4
    Eigen::Array3i bricks = Eigen::Array3i::Zero();  ///< size / 4
    CellBox box;  ///< the map's bounding box; space outside it counts as free

    /// Per brick: the cells that end rays, bit x + 4 y + 16 z.
    std::vector<std::uint64_t> ends;

    /// Per brick: an empty box that rays in its cells cross in one step, as large as was found; of
    /// size 0 if there is none. Outside the box, rays go from cell to cell.
    std::vector<EmptyBox> boxes;

    /// Textures of a brick: entry brickTextures[brick] * kPatchesPerBrick + 4 * face + layer of
    /// patchOf is an index into patches. Brick textures 0 and patch 0 are empty.
    std::vector<std::int32_t> brickTextures;
    std::vector<std::int32_t> patchOf;
    std::vector<FacePatch> patches;

    /// Surfaces inside the cells of a brick: entry brickTextures[brick] * kCellsPerBrick + x + 4 y
    /// + 16 z of `planes` is a SurfacePlane; or 0, if rays end at the cell's faces; or, with the
    /// code SurfacePlane::kSeveral, has an index into `several` in its low bits. Entry 0 of
    /// `several` is not used.
    static constexpr int kCellsPerBrick = 64;
    std::vector<std::uint32_t> planes;
    std::vector<ShownSurfaces> several;

    /// Index of a brick in the vectors per brick.
    std::size_t brickIndex(const Eigen::Array3i& brick) const {
        return (std::size_t(brick.z()) * bricks.y() + brick.y()) * bricks.x() + brick.x();
    }
};

/// Bit of a cell in the masks of its brick: x + 4 y + 16 z.
constexpr unsigned surfaceBit(int x, int y, int z) {
    return static_cast<unsigned>((x & 3) | (y & 3) << 2 | (z & 3) << 4);
}

/// The cells of a brick.
inline CellBox cellsOf(const Eigen::Array3i& brick) { return {4 * brick, 4 * brick + 4}; }

/// Mask of the cells of a brick that lie in a box, bit x + 4 y + 16 z.
std::uint64_t cellsInside(const CellBox& box, const Eigen::Array3i& brick);

/// The bounding box of some cells of a brick, by their mask.
CellBox boundsOf(std::uint64_t cells, const Eigen::Array3i& brick);

/// The bricks that contain cells of a box.
inline CellBox bricksOf(const CellBox& box) {
    const auto quarter = [](int i) { return i >> 2; };
    return {box.low.unaryExpr(quarter), (box.high + 3).unaryExpr(quarter)};
}

}  // namespace photonav
