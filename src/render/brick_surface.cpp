// SPDX-License-Identifier: BSD-3-Clause
#include "render/brick_surface.hpp"

#include <bit>

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
    if (axis == 2 || mask == 0) return static_cast<std::uint16_t>(mask);
    std::uint64_t bits = 0;
    for (int cell = 0; cell < 16; ++cell) {
        const int bit = axis == 0 ? 4 * cell : (cell & 3) | cell >> 2 << 4;
        bits |= (mask >> bit & 1U) << cell;
    }
    return static_cast<std::uint16_t>(bits);
}

constexpr int kWindow = 8;  // cells along each side of a window

/// Grey values at p, q = -2 ... 5 of a layer, and which of them are known: bit 8 * (q + 2) + p + 2.
struct Window {
    std::array<std::uint16_t, kWindow * kWindow> grey;
    std::array<std::uint32_t, kWindow * kWindow> weight;
    std::uint64_t known = 0;

    /// Merges by weight: a surface near the border of two layers is observed in both, and has to
    /// look alike from both. Equal values stay as they are.
    void add(int place, std::uint16_t value, std::uint32_t addedWeight) {
        const std::uint64_t bit = 1ULL << place;
        if ((known & bit) == 0) {
            known |= bit;
            grey[place] = value;
            weight[place] = addedWeight;
            return;
        }
        const std::uint32_t total = weight[place] + addedWeight;
        const std::uint64_t sum = std::uint64_t{grey[place]} * weight[place] +
                                  std::uint64_t{value} * addedWeight + total / 2;
        grey[place] = static_cast<std::uint16_t>(sum / total);
        weight[place] = total;
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

/// Adds the exposed faces in and around one layer, -1 to 4, of the middle brick.
void addExposedGreys(const SurfaceNeighbours& neighbours, int face, int layer, Window& window) {
    constexpr std::array<int, 3> kStride{1, 3, 9};
    const int axis = face / 2, shift = (layer & 3) * kLayerShift[axis];
    const BrickSurface* const* middle = &neighbours[kMiddle + (layer >> 2) * kStride[axis]];
    for (const WindowOverlap::Brick& brick : kOverlap[axis].bricks) {
        const BrickSurface& surface = *middle[brick.offset];
        std::uint64_t todo = surface.exposed[face] >> shift & brick.cells;
        for (; todo != 0; todo &= todo - 1) {
            const int bit = std::countr_zero(todo), cell = bit + shift;
            window.add(brick.place[bit], surface.grey[cell][face],
                       1U << surface.weight[cell][face]);
        }
    }
}

/// The grey value where no face is exposed, extrapolated: the mean of the four neighbours along the
/// edges, or else of those across the corners. All patches compute the same value, so that they
/// agree where they meet.
std::uint16_t extrapolated(const Window& window, int place) {
    constexpr std::array<int, 8> kAround{1,           -1,          kWindow,      -kWindow,
                                         kWindow + 1, kWindow - 1, -kWindow + 1, -kWindow - 1};
    for (int begin = 0; begin < 8; begin += 4) {
        int sum = 0, count = 0;
        for (int i = begin; i < begin + 4; ++i) {
            const int at = place + kAround[i];
            if ((window.known >> at & 1U) == 0) continue;
            sum += window.grey[at];
            ++count;
        }
        if (count > 0) return static_cast<std::uint16_t>((sum + count / 2) / count);
    }
    return 0;
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
    const int outward = face % 2 == 1 ? 1 : -1;
    Window window;
    addExposedGreys(neighbours, face, layer, window);
    addExposedGreys(neighbours, face, layer + outward, window);
    addExposedGreys(neighbours, face, layer - outward, window);
    FacePatch patch;
    patch.valid = valid;
    for (int q = 0; q < FacePatch::kSide; ++q) {
        for (int p = 0; p < FacePatch::kSide; ++p) {
            const int place = kWindow * (q + 1) + p + 1;
            const bool known = (window.known >> place & 1U) != 0;
            patch.grey[FacePatch::kSide * q + p] =
                known ? window.grey[place] : extrapolated(window, place);
        }
    }
    return patch;
}

}  // namespace photonav
