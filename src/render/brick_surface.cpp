// SPDX-License-Identifier: BSD-3-Clause
#include "render/brick_surface.hpp"

#include <algorithm>
#include <bit>

namespace photonav {
namespace {

using Eigen::Array3i;

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

/// Grey values at p, q = -2 ... 5 of a layer, negative where no face is exposed.
struct Window {
    std::array<std::array<int, 8>, 8> grey;
};

/// The exposed faces in and around one layer, -1 to 4, of the middle brick.
Window exposedGreys(const SurfaceNeighbours& neighbours, int face, int layer) {
    const int axis = face / 2, pAxis = axis == 0 ? 1 : 0, qAxis = axis == 2 ? 1 : 2;
    constexpr std::array<int, 3> kStride{1, 3, 9};
    Window window;
    for (auto& row : window.grey) row.fill(-1);
    for (int brick = 0; brick < 9; ++brick) {
        const int p0 = 4 * (brick % 3) - 2, q0 = 4 * (brick / 3) - 2;  // its corner in the window
        const BrickSurface& surface =
            *neighbours[kMiddle + (layer >> 2) * kStride[axis] + (brick % 3 - 1) * kStride[pAxis] +
                        (brick / 3 - 1) * kStride[qAxis]];
        if (surface.exposed[face] == 0) continue;
        const unsigned exposed = layerOf(surface.exposed[face], axis, layer & 3);
        for (unsigned todo = exposed; todo != 0; todo &= todo - 1) {
            const int cell = std::countr_zero(todo), p = cell & 3, q = cell >> 2;
            if (p0 + p < 0 || p0 + p > 7 || q0 + q < 0 || q0 + q > 7) continue;
            Array3i at;
            at[axis] = layer & 3;
            at[pAxis] = p;
            at[qAxis] = q;
            window.grey[q0 + q][p0 + p] = surface.grey[surfaceBit(at.x(), at.y(), at.z())][face];
        }
    }
    return window;
}

/// Fills gaps of a window from another one.
void fillGaps(Window& window, const Window& other) {
    for (int q = 0; q < 8; ++q) {
        for (int p = 0; p < 8; ++p) {
            if (window.grey[q][p] < 0) window.grey[q][p] = other.grey[q][p];
        }
    }
}

bool hasGaps(const Window& window) {
    return std::any_of(window.grey.begin(), window.grey.end(), [](const auto& row) {
        return std::any_of(row.begin(), row.end(), [](int grey) { return grey < 0; });
    });
}

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

}  // namespace

std::array<std::uint64_t, 6> exposedFaces(const SurfaceNeighbours& neighbours) {
    constexpr std::array<int, 3> kStride{1, 3, 9};
    const BrickSurface& surface = *neighbours[kMiddle];
    std::array<std::uint64_t, 6> exposed;
    for (int f = 0; f < 6; ++f) {
        const int axis = f / 2, side = f % 2 == 1 ? 1 : -1;
        const std::uint64_t beyond = neighbours[kMiddle + side * kStride[axis]]->occupied;
        exposed[f] = surface.known & ~fromNeighbour(surface.occupied, beyond, axis, side > 0);
    }
    return exposed;
}

std::uint16_t exposedInLayer(const BrickSurface& surface, int face, int layer) {
    return layerOf(surface.exposed[face], face / 2, layer);
}

FacePatch makePatch(const SurfaceNeighbours& neighbours, int face, int layer, std::uint16_t valid) {
    // The surface goes on over steps of one cell, out or in: real floors are never flat to the
    // cell, and an edge there would be one of the grid, not of the picture.
    const int outward = face % 2 == 1 ? 1 : -1;
    Window window = exposedGreys(neighbours, face, layer);
    for (const int step : {outward, -outward}) {
        if (hasGaps(window)) fillGaps(window, exposedGreys(neighbours, face, layer + step));
    }
    FacePatch patch;
    patch.valid = valid;
    for (int q = 0; q < FacePatch::kSide; ++q) {
        for (int p = 0; p < FacePatch::kSide; ++p) {
            patch.grey[FacePatch::kSide * q + p] =
                static_cast<std::uint16_t>(continued(window, p + 1, q + 1));
        }
    }
    return patch;
}

}  // namespace photonav
