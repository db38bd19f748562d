// SPDX-License-Identifier: BSD-3-Clause
#include "render/voxel_grid_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace photonav {
namespace {

using Eigen::Array3i;

constexpr double kMaxGridCells = 2147483647.;

/// Extends the box by the leaves below a node; skips nodes that cannot extend it.
void extendBox(const TexturedOcTree& map, const TexturedOcTreeNode& node, const Array3i& lowest,
               int edge, CellBox& box) {
    if ((lowest >= box.low).all() && (lowest + edge <= box.high).all()) return;
    bool leaf = true;
    for (int i = 0; i < 8; ++i) {
        if (!map.nodeChildExists(&node, i)) continue;
        leaf = false;
        const Array3i corner = lowest + edge / 2 * Array3i(i & 1, i >> 1 & 1, i >> 2 & 1);
        extendBox(map, *map.getNodeChild(&node, i), corner, edge / 2, box);
    }
    if (!leaf) return;
    box.low = box.low.min(lowest);
    box.high = box.high.max(lowest + edge);
}

/// The whole bricks around a box.
CellBox wholeBricks(const CellBox& box) {
    const CellBox bricks = bricksOf(box);
    return {4 * bricks.low, 4 * bricks.high};
}

double cellsIn(const CellBox& box) { return (box.high - box.low).cast<double>().prod(); }

/// The space to allocate for a box: a quarter larger on those sides where `held` was too small, if
/// there may be so many cells. Else it may leave out empty parts of `held`.
CellBox roomFor(const CellBox& box, const CellBox& held) {
    CellBox room = wholeBricks(box);
    if (cellsIn(room) > kMaxGridCells) {
        const Array3i size = box.high - box.low;
        throw MapTooLarge(
            fmt::format("voxel view: the map's bounding box has {} x {} x {} "
                        "cells, more than 2^31; use a "
                        "coarser map or a part of it",
                        size.x(), size.y(), size.z()));
    }
    if (held.empty()) return room;
    const Array3i spare = ((box.high - box.low) / 4).max(8);
    const CellBox more = wholeBricks({(box.low < held.low).select(box.low - spare, held.low),
                                      (box.high > held.high).select(box.high + spare, held.high)});
    return cellsIn(more) > kMaxGridCells ? room : more;
}

/// The rows of a dense array in another one, as far as they fit into it; the rest is zero.
template <class T>
std::vector<T> movedRows(const std::vector<T>& from, const Array3i& fromSize, const Array3i& toSize,
                         const Array3i& offset) {
    std::vector<T> to(toSize.cast<std::size_t>().prod(), T{});
    const Array3i low = (-offset).max(0), high = fromSize.min(toSize - offset);
    if ((low >= high).any()) return to;
    for (int z = low.z(); z < high.z(); ++z) {
        for (int y = low.y(); y < high.y(); ++y) {
            const auto in = (std::size_t(z) * fromSize.y() + y) * fromSize.x() + low.x();
            const auto out =
                (std::size_t(z + offset.z()) * toSize.y() + y + offset.y()) * toSize.x() + low.x() +
                offset.x();
            std::copy_n(from.data() + in, high.x() - low.x(), to.data() + out);
        }
    }
    return to;
}

}  // namespace

CellBox boundingBox(const TexturedOcTree& map) {
    if (map.size() == 0) return {};
    CellBox box{Array3i::Constant(kKeyOfZero), Array3i::Constant(-kKeyOfZero)};
    extendBox(map, *map.getRoot(), Array3i::Constant(-kKeyOfZero), 2 * kKeyOfZero, box);
    return box;
}

void layOut(const CellBox& box, VoxelGrid& grid) {
    const CellBox held{grid.first, grid.first + grid.size};
    const CellBox needed = box.grown(1);
    if (!held.contains(needed)) moveTo(roomFor(needed, held), grid);
    grid.box = {box.low - grid.first, box.high - grid.first};
}

void moveTo(const CellBox& space, VoxelGrid& grid) {
    const Array3i before = grid.bricks, offset = (grid.first - space.low) / 4;
    grid.first = space.low;
    grid.size = space.high - space.low;
    grid.bricks = grid.size / 4;
    if ((grid.bricks == before).all() && (offset == 0).all()) return;
    grid.ends = movedRows(grid.ends, before, grid.bricks, offset);
    grid.boxes = movedRows(grid.boxes, before, grid.bricks, offset);
    grid.brickTextures = movedRows(grid.brickTextures, before, grid.bricks, offset);
}

void addBricks(const CellBox& box, std::vector<Array3i>& bricks) {
    const CellBox whole = bricksOf(box);
    for (int z = whole.low.z(); z < whole.high.z(); ++z) {
        for (int y = whole.low.y(); y < whole.high.y(); ++y) {
            for (int x = whole.low.x(); x < whole.high.x(); ++x) bricks.emplace_back(x, y, z);
        }
    }
}

}  // namespace photonav
