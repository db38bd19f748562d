// SPDX-License-Identifier: BSD-3-Clause
#include "map/cell_surfaces.hpp"

#include <algorithm>
#include <cmath>

namespace photonav {
namespace {

using Eigen::Vector3f;

constexpr float kLeastWeightShare = 0.1F;  // of the heaviest surface's weight: less is noise
constexpr float kSameCosine = 0.7F;        // surfaces whose normals are closer are one
constexpr float kOppositeCosine = -0.9F;

Vector3f toVector(const std::array<std::int16_t, 3>& v) {
    return Vector3f(v[0], v[1], v[2]) / FaceSurface::kUnit;
}

void average(std::array<std::int16_t, 3>& mean, const Vector3f& value, float share) {
    for (unsigned a = 0; a < 3; ++a) {
        const float target = std::clamp(value[a], -1.F, 1.F) * FaceSurface::kUnit;
        mean[a] = static_cast<std::int16_t>(
            std::lrint(mean[a] + (target - static_cast<float>(mean[a])) * share));
    }
}

/// A surface of a cell: point and unit normal.
struct SeenSurface {
    unsigned face;
    Vector3f point, normal;
};

std::uint32_t field(float value, float unit, int limit, unsigned bits, unsigned shift) {
    const auto units = std::clamp(static_cast<int>(std::lrint(value / unit)), -limit, limit);
    return (static_cast<std::uint32_t>(units) & ((1U << bits) - 1U)) << shift;
}

int valueOf(std::uint32_t plane, unsigned bits, unsigned shift) {
    return static_cast<std::int32_t>(plane << (32U - bits - shift)) >> (32U - bits);
}

std::uint32_t planeOf(const SeenSurface& s) {
    int a = 0;
    s.normal.cwiseAbs().maxCoeff(&a);
    const int p = a == 0 ? 1 : 0, q = a == 2 ? 1 : 2;
    const float slopeP = -s.normal[p] / s.normal[a], slopeQ = -s.normal[q] / s.normal[a];
    const float offset = s.point[a] - slopeP * s.point[p] - slopeQ * s.point[q];
    const auto code = static_cast<std::uint32_t>(2 * a + (s.normal[a] > 0.F ? 2 : 1));
    return field(slopeP, SurfacePlane::kSlopeUnit, 255, 9, 0) |
           field(slopeQ, SurfacePlane::kSlopeUnit, 255, 9, 9) |
           field(offset, SurfacePlane::kOffsetUnit, 1023, 11, 18) | code << 29U;
}

/// The heaviest surfaces of a cell that differ, in the order of their faces. @returns how many
unsigned distinctSurfaces(const std::array<FaceSurface, 6>& cell,
                          std::array<SeenSurface, ShownSurfaces::kMost>& found) {
    std::array<float, 6> weight{};
    for (unsigned f = 0; f < 6; ++f) weight[f] = cell[f].weight;
    const float least = kLeastWeightShare * *std::ranges::max_element(weight);
    unsigned count = 0;
    while (count < ShownSurfaces::kMost) {
        const auto heaviest = std::ranges::max_element(weight);
        if (*heaviest <= 0.F || *heaviest < least) break;
        const auto face = static_cast<unsigned>(heaviest - weight.begin());
        const Vector3f normal = cell[face].meanNormal();
        const SeenSurface surface{face, cell[face].meanPoint(), normal.normalized()};
        *heaviest = 0.F;
        const bool isNew = normal.squaredNorm() > 1e-6F &&
                           std::none_of(found.begin(), found.begin() + count, [&](const auto& s) {
                               return s.normal.dot(surface.normal) > kSameCosine;
                           });
        if (isNew) found[count++] = surface;
    }
    std::sort(found.begin(), found.begin() + count,
              [](const auto& a, const auto& b) { return a.face < b.face; });
    return count;
}

/// Bit of ShownSurfaces::edges for a pair, by how their points lie to each other's planes.
std::uint32_t edgeOf(const SeenSurface& a, const SeenSurface& b, unsigned pair) {
    if (a.normal.dot(b.normal) < kOppositeCosine) return 0;
    const float bend = (a.normal - b.normal).dot(b.point - a.point);
    return 1U << (bend < 0.F ? pair : pair + 3U);
}

}  // namespace

void FaceSurface::observe(const Vector3f& p, const Vector3f& n, float addedWeight,
                          float maxWeight) {
    weight += addedWeight;
    const float share = addedWeight / weight;
    average(point, p, share);
    average(normal, n, share);
    weight = std::min(weight, maxWeight);
}

Vector3f FaceSurface::meanPoint() const { return toVector(point); }

Vector3f FaceSurface::meanNormal() const { return toVector(normal); }

CellSurfaces& CellSurfaces::operator=(const CellSurfaces& other) {
    if (this == &other) return *this;
    content_ = other.content_ ? std::make_unique<Content>(*other.content_) : nullptr;
    return *this;
}

const CellSurfaces::Content& CellSurfaces::content() const {
    static const Content kNone;
    return content_ ? *content_ : kNone;
}

FaceSurface& CellSurfaces::obtain(unsigned face) {
    if (!content_) content_ = std::make_unique<Content>();
    return content_->faces[face];
}

bool CellSurfaces::operator==(const CellSurfaces& other) const {
    return content().faces == other.content().faces;
}

void CellSurfaces::refreshShown() {
    if (!content_) return;
    ShownSurfaces& shown = content_->shown = {};
    std::array<SeenSurface, ShownSurfaces::kMost> found;
    const unsigned count = distinctSurfaces(content_->faces, found);
    for (unsigned i = 0; i < count; ++i) {
        shown.plane[i] = planeOf(found[i]);
        for (unsigned j = 0; j < i; ++j) shown.edges |= edgeOf(found[j], found[i], i + j - 1);
    }
}

float surfaceMotion(const ShownSurfaces& before, const ShownSurfaces& after) {
    if (before.edges != after.edges) return 1.F;
    float most = 0.F;
    for (unsigned i = 0; i < ShownSurfaces::kMost; ++i) {
        const std::uint32_t a = before.plane[i], b = after.plane[i];
        if (a == b) continue;
        if (SurfacePlane::codeOf(a) != SurfacePlane::codeOf(b)) return 1.F;
        const auto moved = [&](unsigned bits, unsigned shift, float unit) {
            const int units = std::abs(valueOf(a, bits, shift) - valueOf(b, bits, shift));
            return static_cast<float>(units) * unit;
        };
        most = std::max({most, moved(9, 0, SurfacePlane::kSlopeUnit),
                         moved(9, 9, SurfacePlane::kSlopeUnit),
                         moved(11, 18, SurfacePlane::kOffsetUnit)});
    }
    return most;
}

}  // namespace photonav
