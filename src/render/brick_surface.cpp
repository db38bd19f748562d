// SPDX-License-Identifier: BSD-3-Clause
#include "render/brick_surface.hpp"

#include <bit>
#include <cstring>

namespace photonav {
namespace {

constexpr int kMiddle = 13;  // of SurfaceNeighbours

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
    if (axis == 0) {  // every fourth bit: to the lowest four of every sixteen
        mask = (mask | mask >> 3U) & 0x0303030303030303U;
        mask = (mask | mask >> 6U) & 0x000F000F000F000FU;
    }
    if (axis != 2) mask |= mask >> 12U | mask >> 24U | mask >> 36U;
    return static_cast<std::uint16_t>(mask);
}

constexpr int kWindow = 8;  // cells along each side of a window

/// Grey values at p, q = -2 ... 5 of a layer: place 8 * (q + 2) + p + 2.
struct Window {
    using Row [[gnu::vector_size(4 * kWindow)]] = std::int32_t;
    static constexpr int kMargin = kWindow + 1;  ///< to read all around a row

    std::array<std::int32_t, kWindow * kWindow + 2 * kMargin> grey{};  ///< 0 where unknown
    std::array<std::int32_t, kWindow * kWindow + 2 * kMargin> known{};
    std::array<std::uint32_t, kWindow * kWindow> weight;

    /// Merges by weight: a surface near the border of two layers is observed in both, and has to
    /// look alike from both. Equal values stay as they are.
    void add(int place, std::uint16_t value, std::uint32_t addedWeight) {
        std::int32_t& merged = grey[place + kMargin];
        if (known[place + kMargin] == 0) {
            known[place + kMargin] = 1;
            merged = value;
            weight[place] = addedWeight;
            return;
        }
        const std::uint32_t total = weight[place] + addedWeight;
        const std::uint64_t sum =
            std::uint64_t(merged) * weight[place] + std::uint64_t{value} * addedWeight + total / 2;
        merged = static_cast<std::int32_t>(sum / total);
        weight[place] = total;
    }

    /// A row of places. Where no face is exposed, grey values are extrapolated: the mean of the
    /// four neighbours along the edges, or else of those across the corners. All patches compute
    /// the same value, so that they agree where they meet.
    Row filledRow(int row) const {
        const auto at = [row](const auto& values, int offset) {
            Row part;
            std::memcpy(&part, &values[kMargin + kWindow * row + offset], sizeof(part));
            return part;
        };
        const auto alongEdges = [&](const auto& values) {
            return at(values, 1) + at(values, -1) + at(values, kWindow) + at(values, -kWindow);
        };
        const auto acrossCorners = [&](const auto& values) {
            return at(values, kWindow + 1) + at(values, kWindow - 1) + at(values, -kWindow + 1) +
                   at(values, -kWindow - 1);
        };
        const Row beside = alongEdges(known);
        const Row sum = beside > 0 ? alongEdges(grey) : acrossCorners(grey);
        const Row count = beside > 0 ? beside : acrossCorners(known);
        using Floats [[gnu::vector_size(4 * kWindow)]] = float;  // exact below 2^24
        const auto mean = __builtin_convertvector(sum + count / 2, Floats) /
                          __builtin_convertvector(count > 0 ? count : 1 - count, Floats);
        return at(known, 0) > 0 ? at(grey, 0) : __builtin_convertvector(mean, Row);
    }
};

/// The coordinates of a layer: p and q run along the axes that are not its normal.
struct LayerAxes {
    int p, q;
    explicit constexpr LayerAxes(int normal) : p(normal == 0 ? 1 : 0), q(normal == 2 ? 1 : 2) {}
};

/// How the nine bricks around a layer lie in its window.
struct WindowOverlap {
    struct Brick {
        int offset = 0;                       // in SurfaceNeighbours
        std::uint64_t cells = 0;              // of the brick's first layer, those in the window
        std::array<std::int8_t, 64> place{};  // in the window, of a cell of the first layer
    };
    std::array<Brick, 9> bricks;

    explicit constexpr WindowOverlap(int normal) {
        constexpr std::array<int, 3> kStride{1, 3, 9};
        const LayerAxes axes(normal);
        for (int i = 0; i < 9; ++i) {
            Brick& brick = bricks[i];
            const int p0 = i % 3 - 1, q0 = i / 3 - 1;
            brick.offset = p0 * kStride[axes.p] + q0 * kStride[axes.q];
            for (int cell = 0; cell < 16; ++cell) {
                const int p = cell % 4, q = cell / 4;
                const int column = 4 * p0 + p + 2, row = 4 * q0 + q + 2;
                if (column < 0 || column >= kWindow || row < 0 || row >= kWindow) continue;
                const int bit = p * kLayerShift[axes.p] + q * kLayerShift[axes.q];
                brick.cells |= 1ULL << bit;
                brick.place[bit] = static_cast<std::int8_t>(kWindow * row + column);
            }
        }
    }
};

constexpr std::array<WindowOverlap, 3> kOverlap{WindowOverlap(0), WindowOverlap(1),
                                                WindowOverlap(2)};

/// One layer of all bricks around, -1 to 4 counted from the middle brick.
struct AroundLayer {
    const BrickSurface* const* middle;
    int shift;

    AroundLayer(const SurfaceNeighbours& neighbours, int axis, int layer)
        : middle(&neighbours[kMiddle + (layer >> 2) * kStride[axis]]),
          shift((layer & 3) * kLayerShift[axis]) {}
    static constexpr std::array<int, 3> kStride{1, 3, 9};
};

/// Adds the exposed faces in and around one layer, and then those one step outward and inward.
void addExposedGreys(const SurfaceNeighbours& neighbours, int face, int layer, Window& window) {
    const int axis = face / 2, outward = face % 2 == 1 ? 1 : -1;
    const std::array layers{AroundLayer(neighbours, axis, layer),
                            AroundLayer(neighbours, axis, layer + outward),
                            AroundLayer(neighbours, axis, layer - outward)};
    for (const WindowOverlap::Brick& brick : kOverlap[axis].bricks) {
        for (const auto& [middle, shift] : layers) {
            const BrickSurface& surface = *middle[brick.offset];
            std::uint64_t todo = surface.exposed[face] >> shift & brick.cells;
            for (; todo != 0; todo &= todo - 1) {
                const int bit = std::countr_zero(todo), cell = bit + shift;
                window.add(brick.place[bit], surface.grey[face][cell],
                           1U << surface.weight[face][cell]);
            }
        }
    }
}

/// The faces that the surfaces inside a brick's cells point to.
std::array<std::uint64_t, 6> facesInside(const BrickSurface& surface) {
    std::array<std::uint64_t, 6> faces{};
    for (std::uint64_t todo = surface.known; todo != 0; todo &= todo - 1) {
        const int bit = std::countr_zero(todo);
        for (const std::uint32_t plane : surface.inside[bit].plane) {
            if (plane != 0) faces[SurfacePlane::codeOf(plane) - 1] |= 1ULL << bit;
        }
    }
    return faces;
}

}  // namespace

std::array<std::uint64_t, 6> exposedFaces(const SurfaceNeighbours& neighbours) {
    constexpr std::array<int, 3> kStride{1, 3, 9};
    const BrickSurface& surface = *neighbours[kMiddle];
    std::array<std::uint64_t, 6> exposed = facesInside(surface);
    for (int f = 0; f < 6; ++f) {
        const int axis = f / 2, side = f % 2 == 1 ? 1 : -1;
        const std::uint64_t beyond = neighbours[kMiddle + side * kStride[axis]]->occupied;
        exposed[f] |= surface.known & ~fromNeighbour(surface.occupied, beyond, axis, side > 0);
    }
    return exposed;
}

std::uint16_t exposedInLayer(const BrickSurface& surface, int face, int layer) {
    return layerOf(surface.exposed[face], face / 2, layer);
}

FacePatch makePatch(const SurfaceNeighbours& neighbours, int face, int layer, std::uint16_t valid) {
    // A surface is continued over steps of one cell, outward or inward: mapped floors are never
    // flat to the cell, and an edge at such a step would come from the grid, not from the texture.
    Window window;
    addExposedGreys(neighbours, face, layer, window);
    FacePatch patch;
    patch.valid = valid;
    for (int q = 0; q < FacePatch::kSide; ++q) {
        const Window::Row row = window.filledRow(q + 1);
        for (int p = 0; p < FacePatch::kSide; ++p) {
            patch.grey[FacePatch::kSide * q + p] = static_cast<std::uint16_t>(row[p + 1]);
        }
    }
    return patch;
}

}  // namespace photonav
