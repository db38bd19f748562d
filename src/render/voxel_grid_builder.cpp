// SPDX-License-Identifier: BSD-3-Clause
#include "render/voxel_grid_builder.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "map/brick_leaves.hpp"
#include "render/brick_reader.hpp"
#include "render/voxel_grid_layout.hpp"

namespace photonav {
namespace {

using Eigen::Array3i;

CellBox cellsOf(const Array3i& brick) { return {4 * brick, 4 * brick + 4}; }

/// The cells of a brick that lie in the map's bounding box.
std::uint64_t insideMask(const VoxelGrid& grid, const Array3i& brick) {
    const CellBox part = cellsOf(brick).clippedTo(grid.box);
    if (part.empty()) return 0;
    const Array3i low = part.low - 4 * brick, high = part.high - 4 * brick;
    if ((low == 0).all() && (high == 4).all()) return ~0ULL;
    std::uint64_t mask = 0;
    for (int z = low.z(); z < high.z(); ++z) {
        for (int y = low.y(); y < high.y(); ++y) {
            for (int x = low.x(); x < high.x(); ++x) mask |= 1ULL << surfaceBit(x, y, z);
        }
    }
    return mask;
}

constexpr int kInfluence =
    VoxelGrid::kMaxDistance - 1;  // a cell changes distances within this [cells]

/// Adds cells to a few boxes that together contain everything that changed, such that few other
/// cells are recomputed. (A box may be recomputed before its neighbour: the values that it reads
/// from there before they are updated lie in both boxes.)
void addToBoxes(const CellBox& cells, const CellBox& within, std::vector<CellBox>& boxes) {
    const auto cellsToMeasure = [&](const CellBox& box) {
        const CellBox measured = box.grown(kInfluence).clippedTo(within);
        return (measured.high - measured.low).cast<double>().prod();
    };
    const double alone = cellsToMeasure(cells);
    double least = alone;
    CellBox* best = nullptr;
    for (CellBox& box : boxes) {
        CellBox both = box;
        both.extend(cells);
        const double more = cellsToMeasure(both) - cellsToMeasure(box);
        if (more > least) continue;
        least = more;
        best = &box;
    }
    if (best != nullptr) {
        best->extend(cells);
    } else {
        boxes.push_back(cells);
    }
}

/// Marks the cells of a brick that end rays. @returns whether a cell changed
bool setEnds(VoxelGrid& grid, const Array3i& brick, std::uint64_t ends) {
    bool changed = false;
    for (int row = 0; row < 16; ++row) {
        std::uint8_t* cells =
            grid.distance.data() +
            grid.cellIndex(4 * brick.x(), 4 * brick.y() + (row & 3), 4 * brick.z() + (row >> 2));
        for (int x = 0; x < 4; ++x, ends >>= 1U) {
            const bool endsHere = (ends & 1U) != 0;
            if (endsHere == (cells[x] == 0)) continue;
            cells[x] = endsHere ? std::uint8_t{0} : VoxelGrid::kMaxDistance;
            changed = true;
        }
    }
    return changed;
}

/// The map's bounding box after a change, in world indices.
CellBox extendedBox(const TexturedOcTree& map, const MapChange& change, const VoxelGrid& grid) {
    CellBox box{grid.box.low + grid.first, grid.box.high + grid.first};
    for (const Array3i& brick : change.occupancy) {
        const CellBox cells = cellsOf(brick);
        if ((cells.low >= box.low).all() && (cells.high <= box.high).all()) continue;
        std::uint64_t present = readBrick(map, brick).present;
        for (; present != 0; present &= present - 1) {
            const int bit = std::countr_zero(present);
            const Array3i cell = cells.low + Array3i(bit & 3, bit >> 2 & 3, bit >> 4);
            box.extend({cell, cell + 1});
        }
    }
    return box;
}

std::uint64_t endsOf(const VoxelGrid& grid, const Array3i& brick, const BrickContent& content,
                     bool unknownEndsRays) {
    if (!unknownEndsRays) return content.surface.occupied;
    return content.surface.occupied | (~content.present & insideMask(grid, brick));
}

bool isSeveral(std::uint32_t plane) {
    return SurfacePlane::codeOf(plane) == SurfacePlane::kSeveral;
}

std::uint32_t severalOf(std::uint32_t plane) { return plane & 0x1FFFFFFFU; }

bool isInGrid(const VoxelGrid& grid, const Array3i& brick) {
    return (brick >= 0).all() && (brick < grid.bricks).all();
}

}  // namespace

VoxelGridBuilder::VoxelGridBuilder(const TexturedOcTree& map, UnknownPolicy unknown,
                                   VoxelGrid& grid)
    : unknownEndsRays_(unknown == UnknownPolicy::occupied) {
    grid.resolution = map.getResolution();
    layOut(boundingBox(map), grid);
    grid.patches.assign(1, {});
    grid.patchOf.assign(VoxelGrid::kPatchesPerBrick, 0);
    grid.planes.assign(VoxelGrid::kCellsPerBrick, 0);
    grid.several.assign(1, {});
    if (unknownEndsRays_) fillBox(grid, grid.box, 0);
    Bricks changed, rewritten;
    if (map.size() > 0) {
        readAll(map, *map.getRoot(), Array3i::Constant(-kKeyOfZero) - grid.first, 2 * kKeyOfZero,
                grid, changed);
    }
    measureDistances(grid, grid.reach());
    refreshPatches(changed, grid, rewritten);
}

/// A plain recursion: far quicker than OctoMap's iterators.
void VoxelGridBuilder::readAll(const TexturedOcTree& map, const TexturedOcTreeNode& node,
                               const Array3i& lowest, int edge, VoxelGrid& grid, Bricks& changed) {
    if (edge > 4 && hasChildren(map, node)) {
        for (int i = 0; i < 8; ++i) {
            if (!map.nodeChildExists(&node, i)) continue;
            const Array3i corner = lowest + edge / 2 * Array3i(i & 1, i >> 1 & 1, i >> 2 & 1);
            readAll(map, *map.getNodeChild(&node, i), corner, edge / 2, grid, changed);
        }
        return;
    }
    const BrickContent content = readBrick(map, node);
    const Array3i first = lowest / 4;
    for (int z = 0; z < edge / 4; ++z) {
        for (int y = 0; y < edge / 4; ++y) {
            for (int x = 0; x < edge / 4; ++x) {
                const Array3i brick = first + Array3i(x, y, z);
                setEnds(grid, brick, endsOf(grid, brick, content, unknownEndsRays_));
                if (setSurface(grid.brickIndex(brick), content.surface, grid)) {
                    changed.push_back(brick);
                }
            }
        }
    }
}

GridUpdate VoxelGridBuilder::update(const TexturedOcTree& map, const MapChange& change,
                                    VoxelGrid& grid) {
    GridUpdate update;
    if (change.empty()) return update;
    if (change.resolution != grid.resolution || map.getResolution() != grid.resolution) {
        throw std::invalid_argument("voxel view: the change is of a map of another resolution");
    }
    Bricks toRead;
    grow(extendedBox(map, change, grid), grid, update, toRead);
    for (const Array3i& brick : change.bricks()) toRead.emplace_back(brick - grid.first / 4);

    std::vector<CellBox> ends;
    Bricks changed;
    for (const Array3i& brick : toRead) {
        if (!isInGrid(grid, brick)) continue;
        const BrickContent content = readBrick(map, Array3i(brick + grid.first / 4));
        if (setEnds(grid, brick, endsOf(grid, brick, content, unknownEndsRays_))) {
            addToBoxes(cellsOf(brick), grid.reach(), ends);
        }
        if (setSurface(grid.brickIndex(brick), content.surface, grid)) changed.push_back(brick);
    }
    for (const CellBox& box : ends) {
        update.cells.push_back(box.grown(kInfluence).clippedTo(grid.reach()));
        measureDistances(grid, update.cells.back());
    }
    refreshPatches(changed, grid, update.bricks);
    return update;
}

/// Extends the grid to the map's new bounding box. New cells are unknown: obstacles, if unknown
/// cells end rays. Distances are computed axis after axis: every step adds a slab to a box, and the
/// shortest path between two cells of a box stays inside it.
void VoxelGridBuilder::grow(const CellBox& box, VoxelGrid& grid, GridUpdate& update,
                            Bricks& toRead) const {
    CellBox before{grid.box.low + grid.first, grid.box.high + grid.first};
    if ((box.low == before.low).all() && (box.high == before.high).all()) return;
    update.laidOutAnew = layOut(box, grid);
    before = {before.low - grid.first, before.high - grid.first};
    if (before.empty()) {  // all of it is new
        update.cells.push_back(grid.reach());
        if (unknownEndsRays_) addBricks(grid.box, toRead);
        return;
    }
    CellBox done = before;
    const auto add = [&](int axis, int from, int to) {
        if (from >= to) return;
        CellBox slab = done;
        slab.low[axis] = from;
        slab.high[axis] = to;
        done.extend(slab);
        update.cells.push_back(slab.grown(1));
        if (unknownEndsRays_) addBricks(slab, toRead);
    };
    for (int axis = 0; axis < 3; ++axis) {
        add(axis, grid.box.low[axis], done.low[axis]);
        add(axis, done.high[axis], grid.box.high[axis]);
    }
    for (const CellBox& slab : update.cells) measureDistances(grid, slab);
}

bool VoxelGridBuilder::setSurface(std::size_t brick, const BrickSurface& surface, VoxelGrid& grid) {
    std::int32_t& textures = grid.brickTextures[brick];
    if (textures == 0) {
        if (surface.occupied == 0) return false;
        textures = static_cast<std::int32_t>(surfaces_.size());
        surfaces_.emplace_back();
        grid.patchOf.resize(surfaces_.size() * VoxelGrid::kPatchesPerBrick, 0);
        grid.planes.resize(surfaces_.size() * VoxelGrid::kCellsPerBrick, 0);
    }
    if (surfaces_[textures].hasSameCells(surface)) return false;
    surfaces_[textures] = surface;
    setPlanes(textures, grid);
    return true;
}

void VoxelGridBuilder::setPlanes(std::int32_t textures, VoxelGrid& grid) {
    std::uint32_t* planes = &grid.planes[std::size_t(textures) * VoxelGrid::kCellsPerBrick];
    for (int bit = 0; bit < VoxelGrid::kCellsPerBrick; ++bit) {
        const ShownSurfaces& inside = surfaces_[textures].inside[bit];
        if (isSeveral(planes[bit])) freeSeveral_.push_back(severalOf(planes[bit]));
        planes[bit] = inside.plane[0];
        if (!inside.several()) continue;
        if (freeSeveral_.empty()) {
            freeSeveral_.push_back(static_cast<std::uint32_t>(grid.several.size()));
            grid.several.emplace_back();
        }
        grid.several[freeSeveral_.back()] = inside;
        planes[bit] = SurfacePlane::kSeveral << 29U | freeSeveral_.back();
        freeSeveral_.pop_back();
    }
}

SurfaceNeighbours VoxelGridBuilder::neighboursOf(const Array3i& brick,
                                                 const VoxelGrid& grid) const {
    SurfaceNeighbours neighbours;
    std::size_t i = 0;
    for (int z = -1; z <= 1; ++z) {
        for (int y = -1; y <= 1; ++y) {
            for (int x = -1; x <= 1; ++x) {
                const Array3i at = brick + Array3i(x, y, z);
                neighbours[i++] =
                    &surfaces_[isInGrid(grid, at) ? grid.brickTextures[grid.brickIndex(at)] : 0];
            }
        }
    }
    return neighbours;
}

/// Patches depend on the cells of their brick and on up to two cells beyond it.
void VoxelGridBuilder::refreshPatches(const Bricks& changed, VoxelGrid& grid, Bricks& rewritten) {
    std::vector<bool> isListed(grid.brickTextures.size(), false);
    for (const Array3i& brick : changed) {
        const Array3i low = (brick - 1).max(0), high = (brick + 1).min(grid.bricks - 1);
        for (int z = low.z(); z <= high.z(); ++z) {
            for (int y = low.y(); y <= high.y(); ++y) {
                for (int x = low.x(); x <= high.x(); ++x) {
                    const std::size_t at = grid.brickIndex({x, y, z});
                    if (grid.brickTextures[at] == 0 || isListed[at]) continue;
                    isListed[at] = true;
                    rewritten.emplace_back(x, y, z);
                }
            }
        }
    }
    for (const Array3i& brick : rewritten) {
        surfaces_[grid.brickTextures[grid.brickIndex(brick)]].exposed =
            exposedFaces(neighboursOf(brick, grid));
    }
    for (const Array3i& brick : rewritten) {
        makePatches(neighboursOf(brick, grid), grid.brickTextures[grid.brickIndex(brick)], grid);
    }
}

void VoxelGridBuilder::makePatches(const SurfaceNeighbours& neighbours, std::int32_t textures,
                                   VoxelGrid& grid) {
    for (int i = 0; i < VoxelGrid::kPatchesPerBrick; ++i) {
        const int face = i / 4, layer = i % 4;
        std::int32_t& patch = grid.patchOf[std::size_t(textures) * VoxelGrid::kPatchesPerBrick + i];
        const std::uint16_t valid = exposedInLayer(surfaces_[textures], face, layer);
        if (valid == 0) {
            if (patch != 0) freePatches_.push_back(patch);
            patch = 0;
            continue;
        }
        if (patch == 0 && !freePatches_.empty()) {
            patch = freePatches_.back();
            freePatches_.pop_back();
        } else if (patch == 0) {
            patch = static_cast<std::int32_t>(grid.patches.size());
            grid.patches.emplace_back();
        }
        grid.patches[patch] = makePatch(neighbours, face, layer, valid);
    }
}

void copyUpdate(const VoxelGrid& grid, const GridUpdate& update, VoxelGrid& copy) {
    copy.box = grid.box;
    for (const CellBox& box : update.cells) {
        const int length = box.high.x() - box.low.x();
        for (int z = box.low.z(); z < box.high.z(); ++z) {
            for (int y = box.low.y(); y < box.high.y(); ++y) {
                const std::size_t row = grid.cellIndex(box.low.x(), y, z);
                std::copy_n(grid.distance.data() + row, length, copy.distance.data() + row);
            }
        }
    }
    copy.patchOf.resize(grid.patchOf.size(), 0);
    copy.patches.resize(grid.patches.size());
    copy.planes.resize(grid.planes.size(), 0);
    copy.several.resize(grid.several.size());
    for (const Array3i& at : update.bricks) {
        const std::size_t brick = grid.brickIndex(at);
        const std::int32_t textures = copy.brickTextures[brick] = grid.brickTextures[brick];
        const std::size_t entry = std::size_t(textures) * VoxelGrid::kPatchesPerBrick;
        for (std::size_t i = entry; i < entry + VoxelGrid::kPatchesPerBrick; ++i) {
            copy.patchOf[i] = grid.patchOf[i];
            copy.patches[grid.patchOf[i]] = grid.patches[grid.patchOf[i]];
        }
        const std::size_t cells = std::size_t(textures) * VoxelGrid::kCellsPerBrick;
        for (std::size_t i = cells; i < cells + VoxelGrid::kCellsPerBrick; ++i) {
            const std::uint32_t plane = copy.planes[i] = grid.planes[i];
            if (isSeveral(plane)) copy.several[severalOf(plane)] = grid.several[severalOf(plane)];
        }
    }
}

}  // namespace photonav
