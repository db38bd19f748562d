// SPDX-License-Identifier: BSD-3-Clause
#include "render/border_finder.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "photometry/simd.hpp"
#include "render/image_function.hpp"
#include "render/triangle_cache.hpp"

namespace photonav {
namespace {

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

/// A flat convex surface in the image (see Rasterizer).
struct Outline {
    unsigned sides = 0;
    std::array<ImageFunction, 4> edges;  ///< not negative inside
    ImageFunction inverseDepth;          ///< [1/m]
};

Outline outlineOf(const FlatSurface& surface, const Camera& camera, const Pose& T_c_w) {
    std::array<Eigen::Vector3d, 4> p;
    for (unsigned i = 0; i < surface.sides; ++i) p[i] = T_c_w * surface.corners[i].cast<double>();
    const Eigen::Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]);
    const double volume = normal.dot(p[0]);
    Outline outline;
    outline.sides = surface.sides;
    outline.inverseDepth = inPixels(normal / volume, camera);
    for (unsigned i = 0; i < surface.sides; ++i) {
        outline.edges[i] = inPixels(p[i].cross(p[(i + 1) % surface.sides]) / volume, camera);
    }
    return outline;
}

/// Direction from a pixel to its neighbour.
enum class Axis { row, column };

/// A line in the image.
struct Border {
    double at;     ///< from a pixel's centre toward its neighbour's [pixels]
    double slope;  ///< how much `at` changes from one row (or column) of pixels to the next
};

/// The border of two surfaces, of which `first` is seen from (x, y) and `second` from the next
/// pixel. None if it makes less than 45 degrees with the axis: then it lies between neighbours
/// along the other axis.
std::optional<Border> borderBetween(const Outline& first, const Outline& second, double x, double y,
                                    Axis axis) {
    const auto step = [axis](const ImageFunction& f) { return axis == Axis::row ? f.a : f.b; };
    const auto zeroOf = [&](const ImageFunction& f) { return -f(x, y) / step(f); };
    constexpr double kRounding = 1e-6;  // [pixels]
    const ImageFunction none;
    const ImageFunction *exit = &none, *entry = &none;
    double leaves = kNoEnd, enters = -kNoEnd;
    for (const ImageFunction& edge : std::span(first.edges).first(first.sides)) {
        if (step(edge) < 0. && zeroOf(edge) < leaves) leaves = zeroOf(*(exit = &edge));
    }
    for (const ImageFunction& edge : std::span(second.edges).first(second.sides)) {
        if (step(edge) > 0. && zeroOf(edge) > enters) enters = zeroOf(*(entry = &edge));
    }
    // How far the second one is in front of the first one, where both are there.
    const ImageFunction inFront = second.inverseDepth - first.inverseDepth;
    const bool secondCovers =
        enters > -kRounding && inFront(x, y) + std::min(enters, 1.) * step(inFront) > 0.;
    const ImageFunction* line = secondCovers ? entry : exit;
    if (!secondCovers && step(inFront) > 0. && zeroOf(inFront) < leaves) line = &inFront;
    const double across = std::abs(step(*line));
    const double along = std::abs(axis == Axis::row ? line->b : line->a);
    if (axis == Axis::row ? !(across >= along && across > 0.) : !(across > along)) return {};
    return Border{std::clamp(zeroOf(*line), 0., 1.), along / across};
}

/// Share of a pixel beyond a line at a distance from its centre along an axis.
/// @param distance at least 0 [pixels]
/// @param slope 0 to 1, see Border
double shareBeyond(double distance, double slope) {
    const double whole = 0.5 * (1. - slope);  // nearer, the line crosses both sides
    if (distance <= whole) return 0.5 - distance;
    const double left = 0.5 * (1. + slope) - distance;
    return left > 0. ? left * left / (2. * slope) : 0.;
}

class BorderSearch {
  public:
    BorderSearch(const std::vector<FlatSurface>& surfaces, const Camera& camera, const Pose& T_c_w,
                 const VisibilityImage& visible)
        : surfaces_(surfaces), camera_(camera), T_c_w_(T_c_w), visible_(visible) {}

    /// Adds the shares of pixels beyond the borders across rows or columns.
    void search(Axis axis, std::vector<Covering>& found) {
        const unsigned right = axis == Axis::row ? 1 : 0, down = 1 - right;
        const unsigned width = camera_.width - right;
        for (unsigned y = 0; y + down < camera_.height; ++y) {
            const std::uint32_t* ids = visible_.row(y);
            const std::uint32_t* next = visible_.row(y + down) + right;
            for (unsigned x = 0; x < width; x += simd::kWidth) {
                unsigned differ =
                    simd::bits(simd::load<simd::Int>(ids + x) != simd::load<simd::Int>(next + x));
                for (; differ != 0; differ &= differ - 1) {
                    const unsigned u = x + static_cast<unsigned>(std::countr_zero(differ));
                    if (u < width) addPair({u, y}, {u + right, y + down}, axis, found);
                }
            }
        }
    }

  private:
    struct Pixel {
        unsigned x, y;
    };

    const Outline& outline(std::uint32_t id) {
        return outlines_.get(
            id, [&](Outline& slot) { slot = outlineOf(surfaces_[id], camera_, T_c_w_); });
    }

    void addPair(Pixel first, Pixel second, Axis axis, std::vector<Covering>& found) {
        const std::uint32_t id = visible_.row(first.y)[first.x];
        const std::uint32_t nextId = visible_.row(second.y)[second.x];
        if (id == VisibilityImage::kNothing || nextId == VisibilityImage::kNothing ||
            surfaces_[id].otherHalf == nextId) {
            return;
        }
        const Outline copy = outline(id);  // the second one may replace it
        const auto border = borderBetween(copy, outline(nextId), first.x, first.y, axis);
        if (!border) return;
        const auto add = [&](Pixel pixel, std::uint32_t other, double distance, double sign) {
            const double share = shareBeyond(distance, border->slope);
            if (!(share > 0.)) return;
            // A little beyond the border. At the border, as the pixel that shows the other surface
            // at its centre, if the centre is there: so views change smoothly.
            const auto beyond = static_cast<float>(sign * 1.5 * distance);
            found.push_back({pixel.x, pixel.y, other, static_cast<float>(share),
                             axis == Axis::row ? beyond : 0.F, axis == Axis::row ? 0.F : beyond});
        };
        add(first, nextId, border->at, 1.);
        add(second, id, 1. - border->at, -1.);
    }

    const std::vector<FlatSurface>& surfaces_;
    const Camera& camera_;
    const Pose& T_c_w_;
    const VisibilityImage& visible_;
    TriangleCache<Outline> outlines_;
};

/// The corner of a triangle that another one does not have; none if they do not share one edge, or
/// if the texture does not go on across it.
std::optional<unsigned> ownCorner(const Triangle& triangle, const Triangle& other) {
    if (triangle.texture != other.texture) return {};
    unsigned own = 0, count = 0;
    for (unsigned i = 0; i < 3; ++i) {
        bool isShared = false;
        for (unsigned j = 0; j < 3; ++j) {
            isShared |= triangle.corners[i] == other.corners[j] && triangle.uv[i] == other.uv[j];
        }
        if (isShared) continue;
        own = i;
        ++count;
    }
    return count == 1 ? std::optional(own) : std::nullopt;
}

/// The corners of the parallelogram of two triangles; none if they do not make up one.
std::optional<std::array<Eigen::Vector3f, 4>> parallelogramOf(const Triangle& triangle,
                                                              const Triangle& other) {
    constexpr float kFlat = 1e-4F;  // [share of the diagonal]
    const auto i = ownCorner(triangle, other), j = ownCorner(other, triangle);
    if (!i || !j) return {};
    const Eigen::Vector3f& a = triangle.corners[*i];
    const Eigen::Vector3f& b = triangle.corners[(*i + 1) % 3];
    const Eigen::Vector3f& c = other.corners[*j];
    const Eigen::Vector3f& d = triangle.corners[(*i + 2) % 3];
    if ((a + c - b - d).norm() > kFlat * (c - a).norm()) return {};
    return std::array<Eigen::Vector3f, 4>{a, b, c, d};
}

}  // namespace

BorderFinder::BorderFinder(const std::vector<Triangle>& triangles) {
    if (triangles.size() > kMostTriangles) return;
    for (const Triangle& triangle : triangles) {
        const auto& [a, b, c] = triangle.corners;
        surfaces_.push_back({3, {a, b, c, c}, VisibilityImage::kNothing});
    }
    for (std::uint32_t id = 0; id + 1 < surfaces_.size(); ++id) {
        if (surfaces_[id].otherHalf != VisibilityImage::kNothing) continue;
        const auto corners = parallelogramOf(triangles[id], triangles[id + 1]);
        if (!corners) continue;
        surfaces_[id] = {4, *corners, id + 1};
        surfaces_[id + 1] = {4, *corners, id};
    }
}

void BorderFinder::find(const Camera& camera, const Pose& T_c_w, const VisibilityImage& visible,
                        Coverings& coverings) const {
    coverings.alongRows.clear();
    coverings.alongColumns.clear();
    if (surfaces_.empty() || !camera.hasPointSpread) return;
    BorderSearch borders(surfaces_, camera, T_c_w, visible);
    borders.search(Axis::row, coverings.alongRows);
    borders.search(Axis::column, coverings.alongColumns);
}

}  // namespace photonav
