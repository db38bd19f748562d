// SPDX-License-Identifier: BSD-3-Clause
#include "render/voxel_grid_builder.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "map/brick_leaves.hpp"
#include "render/brick_reader.hpp"
#include "render/voxel_boxes.hpp"
#include "render/voxel_grid_layout.hpp"

namespace photonav {
namespace {

using Eigen::Array3i;

/// The map's bounding box after a change, in world indices.
CellBox extendedBox(const TexturedOcTree& map, const MapChange& change, const VoxelGrid& grid) {
    CellBox box{grid.box.low + grid.first, grid.box.high + grid.first};
    for (const Array3i& brick : change.occupancy) {
        if (box.contains(cellsOf(brick))) continue;
        box.extend(boundsOf(readBrick(map, brick).present, brick));
    }
    return box;
}

std::uint64_t endsOf(const VoxelGrid& grid, const Array3i& brick, const BrickContent& content,
                     bool unknownEndsRays) {
    if (!unknownEndsRays) return content.surface.occupied;
    return content.surface.occupied | (~content.present & cellsInside(grid.box, brick));
}

bool isSeveral(std::uint32_t plane) {
    return SurfacePlane::codeOf(plane) == SurfacePlane::kSeveral;
}

std::uint32_t severalOf(std::uint32_t plane) { return plane & 0x1FFFFFFFU; }

bool holdsBrick(const CellBox& bricks, const Array3i& brick) {
    return bricks.contains({brick, brick + 1});
}

/// Lists the bricks that were not there before the grid grew: no box reaches into them.
void addNewBricks(const CellBox& old, const CellBox& all, std::vector<ChangedBrick>& changed) {
    if (old.contains(all)) return;
    for (int z = all.low.z(); z < all.high.z(); ++z) {
        for (int y = all.low.y(); y < all.high.y(); ++y) {
            for (int x = all.low.x(); x < all.high.x(); ++x) {
                if (!holdsBrick(old, {x, y, z})) changed.push_back({{x, y, z}, ~0ULL});
            }
        }
    }
}

}  // namespace

VoxelGridBuilder::VoxelGridBuilder(const TexturedOcTree& map, UnknownPolicy policy, VoxelGrid& grid)
    : unknownEndsRays_(policy == UnknownPolicy::occupied) {
    grid.resolution = map.getResolution();
    layOut(boundingBox(map), grid);
    grid.patches.assign(1, {});
    grid.patchOf.assign(VoxelGrid::kPatchesPerBrick, 0);
    grid.planes.assign(VoxelGrid::kCellsPerBrick, 0);
    grid.several.assign(1, {});
    Bricks unknown, changed, rewritten;
    if (unknownEndsRays_) addBricks(grid.box, unknown);
    for (const Array3i& brick : unknown) {
        grid.ends[grid.brickIndex(brick)] = cellsInside(grid.box, brick);
    }
    if (map.size() > 0) {
        readAll(map, *map.getRoot(), Array3i::Constant(-kKeyOfZero) - grid.first, 2 * kKeyOfZero,
                grid, changed);
    }
    findBoxes(grid);
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
                const std::size_t index = grid.brickIndex(brick);
                grid.ends[index] = endsOf(grid, brick, content, unknownEndsRays_);
                if (setSurface(index, content.surface, grid)) changed.push_back(brick);
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
    const CellBox before{grid.first / 4, grid.first / 4 + grid.bricks};
    Bricks toRead;
    grow(extendedBox(map, change, grid), grid, toRead);
    const Array3i firstBrick = grid.first / 4;
    for (const Array3i& brick : change.bricks()) toRead.emplace_back(brick - firstBrick);

    const CellBox old{before.low - firstBrick, before.high - firstBrick};
    const CellBox all{Array3i::Zero(), grid.bricks};
    std::vector<ChangedBrick> changedEnds;
    Bricks changed;
    for (const Array3i& brick : toRead) {
        if (!holdsBrick(all, brick)) continue;
        const std::size_t index = grid.brickIndex(brick);
        const BrickContent content = readBrick(map, Array3i(brick + firstBrick));
        const std::uint64_t ends = endsOf(grid, brick, content, unknownEndsRays_);
        const std::uint64_t endsBefore = std::exchange(grid.ends[index], ends);
        if (endsBefore != ends && holdsBrick(old, brick))
            changedEnds.push_back({brick, endsBefore});
        if (setSurface(index, content.surface, grid)) changed.push_back(brick);
    }
    addNewBricks(old, all, changedEnds);
    update.boxes = updateBoxes(grid, changedEnds);
    update.boxes.low += firstBrick;
    update.boxes.high += firstBrick;
    refreshPatches(changed, grid, update.bricks);
    for (Array3i& brick : update.bricks) brick += firstBrick;
    return update;
}

/// Extends the grid to the map's new bounding box. New cells are unknown: obstacles, if unknown
/// cells end rays.
void VoxelGridBuilder::grow(const CellBox& box, VoxelGrid& grid, Bricks& toRead) const {
    const CellBox before{grid.box.low + grid.first, grid.box.high + grid.first};
    if ((box.low == before.low).all() && (box.high == before.high).all()) return;
    layOut(box, grid);
    if (!unknownEndsRays_) return;
    if (before.empty()) return addBricks(grid.box, toRead);
    CellBox done{before.low - grid.first, before.high - grid.first};
    const auto add = [&](int axis, int from, int to) {
        if (from >= to) return;
        CellBox slab = done;
        slab.low[axis] = from;
        slab.high[axis] = to;
        done.extend(slab);
        addBricks(slab, toRead);
    };
    for (int axis = 0; axis < 3; ++axis) {
        add(axis, grid.box.low[axis], done.low[axis]);
        add(axis, done.high[axis], grid.box.high[axis]);
    }
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
    const CellBox all{Array3i::Zero(), grid.bricks};
    SurfaceNeighbours neighbours;
    std::size_t i = 0;
    for (int z = -1; z <= 1; ++z) {
        for (int y = -1; y <= 1; ++y) {
            for (int x = -1; x <= 1; ++x) {
                const Array3i at = brick + Array3i(x, y, z);
                neighbours[i++] =
                    &surfaces_[holdsBrick(all, at) ? grid.brickTextures[grid.brickIndex(at)] : 0];
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
    moveTo({grid.first, grid.first + grid.size}, copy);
    copy.box = grid.box;
    const Array3i firstBrick = grid.first / 4;
    const CellBox boxes{update.boxes.low - firstBrick, update.boxes.high - firstBrick};
    for (int z = boxes.low.z(); z < boxes.high.z(); ++z) {
        for (int y = boxes.low.y(); y < boxes.high.y(); ++y) {
            const std::size_t row = grid.brickIndex({boxes.low.x(), y, z});
            const int length = boxes.high.x() - boxes.low.x();
            std::copy_n(grid.ends.data() + row, length, copy.ends.data() + row);
            std::copy_n(grid.boxes.data() + row, length, copy.boxes.data() + row);
        }
    }
    copy.patchOf.resize(grid.patchOf.size(), 0);
    copy.patches.resize(grid.patches.size());
    copy.planes.resize(grid.planes.size(), 0);
    copy.several.resize(grid.several.size());
    for (const Array3i& at : update.bricks) {
        const std::size_t brick = grid.brickIndex(at - firstBrick);
        const std::int32_t textures = copy.brickTextures[brick] = grid.brickTextures[brick];
        const std::size_t entry = std::size_t(textures) * VoxelGrid::kPatchesPerBrick;
        for (std::size_t i = entry; i < entry + VoxelGrid::kPatchesPerBrick; ++i) {
            const std::int32_t patch = copy.patchOf[i] = grid.patchOf[i];
            if (patch != 0) copy.patches[patch] = grid.patches[patch];
        }
        const std::size_t cells = std::size_t(textures) * VoxelGrid::kCellsPerBrick;
        for (std::size_t i = cells; i < cells + VoxelGrid::kCellsPerBrick; ++i) {
            const std::uint32_t plane = copy.planes[i] = grid.planes[i];
            if (isSeveral(plane)) copy.several[severalOf(plane)] = grid.several[severalOf(plane)];
        }
    }
}

}  // namespace photonav
