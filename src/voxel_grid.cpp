// SPDX-License-Identifier: BSD-3-Clause
#include "voxel_grid.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <deque>
#include <stdexcept>

namespace photonav {
namespace {

using Eigen::Array3i;

constexpr double kMostCells = 2147483647.;
constexpr std::uint8_t kFar = 255;

/// What a brick of 4 x 4 x 4 cells knows before neighbours are asked. Bit x + 4 y + 16 z.
struct BrickSurface {
    std::uint64_t occupied = 0;
    std::uint64_t known = 0;                 ///< occupied, and some face of the cell was observed
    std::array<std::uint64_t, 6> exposed{};  ///< known, and the cell before this face is not solid
    std::array<std::array<std::uint16_t, 6>, 64> grey;  ///< of the faces of known cells
};

unsigned cellBit(int x, int y, int z) { return (x & 3) | (y & 3) << 2 | (z & 3) << 4; }

std::uint16_t quantised(float grey) {
    return static_cast<std::uint16_t>(std::lrint(std::clamp(grey, 0.F, 1.F) * 65535.F));
}

Array3i childCorner(const Array3i& lowest, int edge, int child) {
    return lowest + edge / 2 * Array3i(child & 1, child >> 1 & 1, child >> 2 & 1);
}

/// Builds a VoxelGrid in the order of its member functions.
class GridBuilder {
  public:
    GridBuilder(VoxelGrid& grid, const TexturedOcTree& map) : grid_(grid), map_(map) {}

    void layOut();
    void fill(UnknownPolicy unknown);
    void measureDistances();
    void findExposedFaces();
    void makePatches();

  private:
    void extendBox(const TexturedOcTreeNode& node, const Array3i& lowest, int edge, Array3i& low,
                   Array3i& high) const;
    void visit(const TexturedOcTreeNode& node, const Array3i& lowest, int edge);
    void setCells(const TexturedOcTreeNode& leaf, const Array3i& from, const Array3i& to);
    void setSurface(const TexturedOcTreeNode& leaf, int x, int y, int z);
    void gatherNeighbours(const Array3i& brick);
    void makePatches(std::int32_t index);
    // Cells counted from the corner of the brick whose neighbours were gathered, -4 to 7.
    int faceGrey(const Array3i& cell, int face) const;
    int surfaceGrey(const Array3i& cell, int face) const;
    void makePatch(int face, int layer, std::uint16_t valid);

    VoxelGrid& grid_;
    const TexturedOcTree& map_;
    std::array<const BrickSurface*, 27> neighbours_{};
    std::deque<BrickSurface> surfaces_{1};  // index as in VoxelGrid::brickTextures
};

void GridBuilder::layOut() {
    grid_.resolution = map_.getResolution();
    Array3i low = Array3i::Constant(kKeyOfZero), high = Array3i::Constant(-kKeyOfZero);
    if (map_.size() > 0) {
        extendBox(*map_.getRoot(), Array3i::Constant(-kKeyOfZero), 2 * kKeyOfZero, low, high);
    } else {
        low = high = Array3i::Zero();
    }
    grid_.first = low - 1;
    grid_.size = high - low + 2;
    const double cells = grid_.size.cast<double>().prod();
    if (cells > kMostCells) {
        throw std::invalid_argument(fmt::format(
            "voxel view: the map's bounding box has {} x {} x {} cells of {} m, more than 2^31; "
            "use a coarser map or a part of it",
            grid_.size.x(), grid_.size.y(), grid_.size.z(), grid_.resolution));
    }
    grid_.bricks = (grid_.size + 3) / 4;
    grid_.brickTextures.assign(std::size_t(grid_.bricks.prod()), 0);
}

/// Extends the box by the leaves below a node, but goes only where it may grow.
void GridBuilder::extendBox(const TexturedOcTreeNode& node, const Array3i& lowest, int edge,
                            Array3i& low, Array3i& high) const {
    if ((lowest >= low).all() && (lowest + edge <= high).all()) return;
    bool leaf = true;
    for (int i = 0; i < 8; ++i) {
        if (!map_.nodeChildExists(&node, i)) continue;
        leaf = false;
        extendBox(*map_.getNodeChild(&node, i), childCorner(lowest, edge, i), edge / 2, low, high);
    }
    if (!leaf) return;
    low = low.min(lowest);
    high = high.max(lowest + edge);
}

void GridBuilder::fill(UnknownPolicy unknown) {
    const std::size_t cells = std::size_t(grid_.size.x()) * grid_.size.y() * grid_.size.z();
    grid_.distance.assign(cells + 3, kFar);
    if (unknown == UnknownPolicy::occupied) {
        for (int z = 1; z + 1 < grid_.size.z(); ++z) {
            for (int y = 1; y + 1 < grid_.size.y(); ++y) {
                auto* row = &grid_.distance[(std::size_t(z) * grid_.size.y() + y) * grid_.size.x()];
                std::fill(row + 1, row + grid_.size.x() - 1, std::uint8_t{0});
            }
        }
    }
    if (map_.size() > 0) visit(*map_.getRoot(), -kKeyOfZero - grid_.first, 2 * kKeyOfZero);
}

/// A plain recursion: far quicker than OctoMap's iterators.
void GridBuilder::visit(const TexturedOcTreeNode& node, const Array3i& lowest, int edge) {
    bool leaf = true;
    for (int i = 0; i < 8; ++i) {
        if (!map_.nodeChildExists(&node, i)) continue;
        leaf = false;
        visit(*map_.getNodeChild(&node, i), childCorner(lowest, edge, i), edge / 2);
    }
    if (leaf) setCells(node, lowest, lowest + edge);
}

void GridBuilder::setCells(const TexturedOcTreeNode& leaf, const Array3i& from, const Array3i& to) {
    const bool occupied = map_.isNodeOccupied(leaf);
    for (int z = from.z(); z < to.z(); ++z) {
        for (int y = from.y(); y < to.y(); ++y) {
            auto* row = &grid_.distance[(std::size_t(z) * grid_.size.y() + y) * grid_.size.x()];
            std::fill(row + from.x(), row + to.x(), occupied ? std::uint8_t{0} : kFar);
            if (!occupied) continue;
            for (int x = from.x(); x < to.x(); ++x) setSurface(leaf, x, y, z);
        }
    }
}

void GridBuilder::setSurface(const TexturedOcTreeNode& leaf, int x, int y, int z) {
    std::int32_t& index = grid_.brickTextures[grid_.brickIndex(x, y, z)];
    if (index == 0) {
        index = static_cast<std::int32_t>(surfaces_.size());
        surfaces_.emplace_back();
    }
    BrickSurface& surface = surfaces_[index];
    const unsigned bit = cellBit(x, y, z);
    surface.occupied |= 1ULL << bit;
    const std::optional<float> mean = leaf.meanGrey();
    if (!mean) return;
    surface.known |= 1ULL << bit;
    for (int f = 0; f < 6; ++f) {
        const FaceTexture& face = leaf.faces[f];
        surface.grey[bit][f] = quantised(face.observed() ? face.mean : *mean);
    }
}

/// Chessboard distance: one pass forward and one backward over the rows, each taking what the rows
/// already done know (26 neighbours in all).
void GridBuilder::measureDistances() {
    const int nx = grid_.size.x(), ny = grid_.size.y(), nz = grid_.size.z();
    std::vector<std::uint8_t> best(nx + 2, kFar);  // one cell beyond each end of the row
    const auto row = [&](int y, int z) { return &grid_.distance[(std::size_t(z) * ny + y) * nx]; };
    const auto relax = [&](std::uint8_t* cells, int y, int z, int back) {
        std::fill(best.begin(), best.end(), kFar);
        const auto take = [&](int fromY, int fromZ) {
            if (fromY < 0 || fromY >= ny || fromZ < 0 || fromZ >= nz) return;
            const std::uint8_t* from = row(fromY, fromZ);
            for (int x = 0; x < nx; ++x) best[x + 1] = std::min(best[x + 1], from[x]);
        };
        take(y + back, z);
        for (int dy = -1; dy <= 1; ++dy) take(y + dy, z + back);
        for (int x = 0; x < nx; ++x) {
            const std::uint8_t near = std::min(std::min(best[x], best[x + 2]), best[x + 1]);
            cells[x] = std::min(cells[x], static_cast<std::uint8_t>(near + (near != kFar)));
        }
    };
    const auto chain = [](std::uint8_t& cell, unsigned& run) {
        run = std::min<unsigned>(cell, run + 1);
        cell = static_cast<std::uint8_t>(run);
    };
    for (int z = 0; z < nz; ++z) {
        for (int y = 0; y < ny; ++y) {
            std::uint8_t* cells = row(y, z);
            relax(cells, y, z, -1);
            unsigned run = kFar;
            for (int x = 0; x < nx; ++x) chain(cells[x], run);
        }
    }
    for (int z = nz - 1; z >= 0; --z) {
        for (int y = ny - 1; y >= 0; --y) {
            std::uint8_t* cells = row(y, z);
            relax(cells, y, z, 1);
            unsigned run = kFar;
            for (int x = nx - 1; x >= 0; --x) chain(cells[x], run);
        }
    }
}

/// Cells of a brick at coordinate 0 of an axis; the next layer is `kLayerShift` bits further.
constexpr std::array<std::uint64_t, 3> kFirstLayer{0x1111111111111111, 0x000F000F000F000F,
                                                   0x000000000000FFFF};
constexpr std::array<int, 3> kLayerShift{1, 4, 16};

/// Cells of a brick whose neighbour on the given side is in the mask, the neighbouring brick's mask
/// on that side given.
std::uint64_t fromNeighbour(std::uint64_t here, std::uint64_t beyond, int axis, bool positive) {
    const int shift = kLayerShift[axis];
    const std::uint64_t first = kFirstLayer[axis], last = first << 3 * shift;
    return positive ? (here & ~first) >> shift | (beyond & first) << 3 * shift
                    : (here & ~last) << shift | (beyond & last) >> 3 * shift;
}

/// One layer of a brick's mask as bit 4 * q + p.
std::uint16_t layerOf(std::uint64_t mask, int axis, int layer) {
    mask = mask >> kLayerShift[axis] * layer & kFirstLayer[axis];
    if (axis == 2 || mask == 0) return static_cast<std::uint16_t>(mask);
    std::uint64_t bits = 0;
    for (int cell = 0; cell < 16; ++cell) {
        const int bit = axis == 0 ? 4 * cell : (cell & 3) | cell >> 2 << 4;
        bits |= (mask >> bit & 1U) << cell;
    }
    return static_cast<std::uint16_t>(bits);
}

void GridBuilder::findExposedFaces() {
    const Array3i& n = grid_.bricks;
    const std::array<std::int64_t, 3> stride{1, n.x(), std::int64_t(n.x()) * n.y()};
    std::int64_t brick = 0;
    for (int z = 0; z < n.z(); ++z) {
        for (int y = 0; y < n.y(); ++y) {
            for (int x = 0; x < n.x(); ++x, ++brick) {
                if (grid_.brickTextures[brick] == 0) continue;
                BrickSurface& surface = surfaces_[grid_.brickTextures[brick]];
                const Array3i at(x, y, z);
                for (int f = 0; f < 6; ++f) {
                    const int axis = f / 2, side = f % 2 == 1 ? 1 : -1;
                    const int next = at[axis] + side;
                    const std::uint64_t beyond =
                        next < 0 || next >= n[axis]
                            ? 0
                            : surfaces_[grid_.brickTextures[brick + side * stride[axis]]].occupied;
                    surface.exposed[f] =
                        surface.known & ~fromNeighbour(surface.occupied, beyond, axis, side > 0);
                }
            }
        }
    }
}

void GridBuilder::gatherNeighbours(const Array3i& brick) {
    const Array3i end = grid_.bricks;
    std::size_t i = 0;
    for (int z = brick.z() - 1; z <= brick.z() + 1; ++z) {
        for (int y = brick.y() - 1; y <= brick.y() + 1; ++y) {
            for (int x = brick.x() - 1; x <= brick.x() + 1; ++x) {
                const bool inside =
                    x >= 0 && y >= 0 && z >= 0 && x < end.x() && y < end.y() && z < end.z();
                const std::size_t at = (std::size_t(z) * end.y() + y) * end.x() + x;
                neighbours_[i++] = &surfaces_[inside ? grid_.brickTextures[at] : 0];
            }
        }
    }
}

int GridBuilder::faceGrey(const Array3i& cell, int face) const {
    const BrickSurface& surface =
        *neighbours_[9 * (cell.z() >> 2) + 3 * (cell.y() >> 2) + (cell.x() >> 2) + 13];
    const unsigned bit = cellBit(cell.x(), cell.y(), cell.z());
    return (surface.exposed[face] >> bit & 1U) != 0 ? surface.grey[bit][face] : -1;
}

/// The surface goes on over steps of one cell, out or in: real floors are never flat to the cell,
/// and an edge there would be one of the grid, not of the picture.
int GridBuilder::surfaceGrey(const Array3i& cell, int face) const {
    int grey = faceGrey(cell, face);
    for (int side = face % 2 == 1 ? 1 : -1, tries = 0; grey < 0 && tries < 2; side = -side) {
        Array3i step = cell;
        step[face / 2] += side;
        grey = faceGrey(step, face);
        ++tries;
    }
    return grey;
}

/// The surface around one layer of a brick: grey values at p, q = -2 ... 5, negative where it does
/// not go on.
struct Window {
    std::array<std::array<int, 8>, 8> grey;

    bool hasGaps() const {
        for (int q = 1; q < 7; ++q) {
            for (int p = 1; p < 7; ++p) {
                if (grey[q][p] < 0) return true;
            }
        }
        return false;
    }
};

/// Where the surface does not go on, it takes the mean of its neighbours along the edges, or else
/// of those across the corners: the same from every patch, so that patches agree where they meet.
int continued(const Window& window, int p, int q) {
    if (window.grey[q][p] >= 0) return window.grey[q][p];
    constexpr std::array<std::array<int, 2>, 8> kAround{
        {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};
    for (int begin = 0; begin < 8; begin += 4) {
        int sum = 0, count = 0;
        for (int i = begin; i < begin + 4; ++i) {
            const int grey = window.grey[q + kAround[i][1]][p + kAround[i][0]];
            if (grey < 0) continue;
            sum += grey;
            ++count;
        }
        if (count > 0) return (sum + count / 2) / count;
    }
    return 0;
}

void GridBuilder::makePatch(int face, int layer, std::uint16_t valid) {
    const int axis = face / 2, pAxis = axis == 0 ? 1 : 0, qAxis = axis == 2 ? 1 : 2;
    const auto greyAt = [&](int p, int q) {
        Array3i cell;
        cell[axis] = layer;
        cell[pAxis] = p - 2;
        cell[qAxis] = q - 2;
        return surfaceGrey(cell, face);
    };
    Window window;
    for (int q = 1; q < 7; ++q) {
        for (int p = 1; p < 7; ++p) window.grey[q][p] = greyAt(p, q);
    }
    if (window.hasGaps()) {
        for (int i = 0; i < 8; ++i) {
            window.grey[0][i] = greyAt(i, 0);
            window.grey[7][i] = greyAt(i, 7);
            window.grey[i][0] = greyAt(0, i);
            window.grey[i][7] = greyAt(7, i);
        }
    }
    FacePatch& patch = grid_.patches.emplace_back();
    patch.valid = valid;
    for (int q = 0; q < FacePatch::kSide; ++q) {
        for (int p = 0; p < FacePatch::kSide; ++p) {
            patch.grey[FacePatch::kSide * q + p] =
                static_cast<std::uint16_t>(continued(window, p + 1, q + 1));
        }
    }
}

void GridBuilder::makePatches() {
    grid_.patchOf.assign(surfaces_.size() * VoxelGrid::kPatchesPerBrick, 0);
    grid_.patches.assign(1, {});
    std::size_t brick = 0;
    for (int z = 0; z < grid_.bricks.z(); ++z) {
        for (int y = 0; y < grid_.bricks.y(); ++y) {
            for (int x = 0; x < grid_.bricks.x(); ++x, ++brick) {
                if (grid_.brickTextures[brick] == 0) continue;
                gatherNeighbours({x, y, z});
                makePatches(grid_.brickTextures[brick]);
            }
        }
    }
}

void GridBuilder::makePatches(std::int32_t index) {
    const BrickSurface& surface = surfaces_[index];
    for (int i = 0; i < VoxelGrid::kPatchesPerBrick; ++i) {
        const int face = i / 4, layer = i % 4;
        const std::uint16_t valid = layerOf(surface.exposed[face], face / 2, layer);
        if (valid == 0) continue;
        grid_.patchOf[std::size_t(index) * VoxelGrid::kPatchesPerBrick + i] =
            static_cast<std::int32_t>(grid_.patches.size());
        makePatch(face, layer, valid);
    }
}

}  // namespace

VoxelGrid::VoxelGrid(const TexturedOcTree& map, UnknownPolicy unknown) {
    GridBuilder builder(*this, map);
    builder.layOut();
    builder.fill(unknown);
    builder.measureDistances();
    builder.findExposedFaces();
    builder.makePatches();
}

}  // namespace photonav
