// SPDX-License-Identifier: BSD-3-Clause
#include "render/edge_coverage.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "photometry/simd.hpp"

namespace photonav {
namespace {

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

/// The line a x + b y + c = 0 in the image, x and y in pixels; also the function itself.
struct ImageLine {
    double a, b, c;
    double operator()(double x, double y) const { return a * x + b * y + c; }
    ImageLine operator-(const ImageLine& other) const {
        return {a - other.a, b - other.b, c - other.c};
    }
};

ImageLine lineInPixels(const Eigen::Vector3d& perRay, const Camera& camera) {
    const double a = perRay.x() / camera.fx(), b = perRay.y() / camera.fy();
    return {a, b, perRay.z() - a * camera.cx() - b * camera.cy()};
}

/// A flat convex surface in the image (see Rasterizer).
struct Outline {
    std::uint32_t id = VisibilityImage::kNothing;
    unsigned sides = 0;
    std::array<ImageLine, 4> edges;  ///< not negative inside
    ImageLine inverseDepth;          ///< [1/m]
};

Outline outlineOf(std::uint32_t id, const FlatSurface& surface, const Camera& camera,
                  const Pose& T_c_w) {
    std::array<Eigen::Vector3d, 4> p;
    for (unsigned i = 0; i < surface.sides; ++i) p[i] = T_c_w * surface.corners[i].cast<double>();
    const Eigen::Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]);
    const double volume = normal.dot(p[0]);
    Outline outline;
    outline.id = id;
    outline.sides = surface.sides;
    outline.inverseDepth = lineInPixels(normal / volume, camera);
    for (unsigned i = 0; i < surface.sides; ++i) {
        outline.edges[i] = lineInPixels(p[i].cross(p[(i + 1) % surface.sides]) / volume, camera);
    }
    return outline;
}

class OutlineCache {
  public:
    OutlineCache(const std::vector<FlatSurface>& surfaces, const Camera& camera, const Pose& T_c_w)
        : surfaces_(surfaces), camera_(camera), T_c_w_(T_c_w) {}

    const Outline& operator[](std::uint32_t id) {
        Outline& outline = outlines_[id % outlines_.size()];
        if (outline.id != id) outline = outlineOf(id, surfaces_[id], camera_, T_c_w_);
        return outline;
    }

  private:
    const std::vector<FlatSurface>& surfaces_;
    const Camera& camera_;
    const Pose& T_c_w_;
    std::array<Outline, 257> outlines_;  // prime: two triangles that meet seldom share a slot
};

/// Direction from a pixel to its neighbour.
enum class Axis { row, column };

/// A line in the image, `at` pixels from a pixel's centre toward its neighbour's. It moves across
/// this direction by `slope` pixels per pixel.
struct Border {
    double at, slope;
};

/// The border of two surfaces, of which `first` is seen from (x, y) and `second` from the next
/// pixel. None if the border runs rather along the axis than across, as neighbours along the other
/// axis see it better.
std::optional<Border> borderBetween(const Outline& first, const Outline& second, double x, double y,
                                    Axis axis) {
    const auto step = [axis](const ImageLine& f) { return axis == Axis::row ? f.a : f.b; };
    const auto zeroOf = [&](const ImageLine& f) { return -f(x, y) / step(f); };
    const auto none = ImageLine{};
    const ImageLine *exit = &none, *entry = &none;
    double leaves = kNoEnd, enters = -kNoEnd;
    for (const ImageLine& edge : std::span(first.edges).first(first.sides)) {
        if (step(edge) < 0. && zeroOf(edge) < leaves) leaves = zeroOf(*(exit = &edge));
    }
    for (const ImageLine& edge : std::span(second.edges).first(second.sides)) {
        if (step(edge) > 0. && zeroOf(edge) > enters) enters = zeroOf(*(entry = &edge));
    }
    // How far the second one is in front of the first one, where both are there.
    const ImageLine inFront = second.inverseDepth - first.inverseDepth;
    const double begin = std::clamp(enters, 0., 1.);
    const bool secondCovers = inFront(x, y) + begin * step(inFront) > 0.;
    const ImageLine* line = secondCovers ? entry : exit;
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
        : surfaces_(surfaces),
          camera_(camera),
          visible_(visible),
          outlines_(surfaces, camera, T_c_w) {}

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

    void addPair(Pixel first, Pixel second, Axis axis, std::vector<Covering>& found) {
        const std::uint32_t id = visible_.row(first.y)[first.x];
        const std::uint32_t nextId = visible_.row(second.y)[second.x];
        if (id == VisibilityImage::kNothing || nextId == VisibilityImage::kNothing ||
            surfaces_[id].otherHalf == nextId) {
            return;
        }
        const Outline outline = outlines_[id];  // a copy: the second one may replace it
        const auto border = borderBetween(outline, outlines_[nextId], first.x, first.y, axis);
        if (!border) return;
        const auto add = [&](Pixel pixel, std::uint32_t other, double share) {
            if (share > 0.) found.push_back({pixel.x, pixel.y, other, static_cast<float>(share)});
        };
        add(first, nextId, shareBeyond(border->at, border->slope));
        add(second, id, shareBeyond(1. - border->at, border->slope));
    }

    const std::vector<FlatSurface>& surfaces_;
    const Camera& camera_;
    const VisibilityImage& visible_;
    OutlineCache outlines_;
};

/// The corner of a triangle that another one does not have; none if they do not share one edge.
std::optional<unsigned> ownCorner(const Triangle& triangle, const Triangle& other) {
    unsigned own = 0, count = 0;
    for (unsigned i = 0; i < 3; ++i) {
        const auto isSame = [&](const auto& corner) { return corner == triangle.corners[i]; };
        if (std::ranges::any_of(other.corners, isSame)) continue;
        own = i;
        ++count;
    }
    return count == 1 ? std::optional(own) : std::nullopt;
}

/// The parallelogram of two triangles; none if they do not make up one of a single texture.
std::optional<FlatSurface> parallelogramOf(const Triangle& triangle, const Triangle& other) {
    constexpr float kFlat = 1e-4F;  // [share of the diagonal]
    const auto i = ownCorner(triangle, other), j = ownCorner(other, triangle);
    if (triangle.texture != other.texture || !i || !j) return {};
    const Eigen::Vector3f& a = triangle.corners[*i];
    const Eigen::Vector3f& b = triangle.corners[(*i + 1) % 3];
    const Eigen::Vector3f& c = other.corners[*j];
    const Eigen::Vector3f& d = triangle.corners[(*i + 2) % 3];
    if ((a + c - b - d).norm() > kFlat * (c - a).norm()) return {};
    return FlatSurface{4, {a, b, c, d}, VisibilityImage::kNothing};
}

}  // namespace

BorderFinder::BorderFinder(const std::vector<Triangle>& triangles) {
    surfaces_.reserve(triangles.size());
    for (std::uint32_t id = 0; id < triangles.size(); ++id) {
        const auto& [a, b, c] = triangles[id].corners;
        FlatSurface surface{3, {a, b, c, c}, VisibilityImage::kNothing};
        for (const std::uint32_t other : {id ^ 1U, id + 1, id - 1}) {  // as files list them
            if (other >= triangles.size()) continue;
            const auto whole = parallelogramOf(triangles[id], triangles[other]);
            if (!whole) continue;
            surface = *whole;
            surface.otherHalf = other;
            break;
        }
        surfaces_.push_back(surface);
    }
}

void BorderFinder::find(const Camera& camera, const Pose& T_c_w, const VisibilityImage& visible,
                        std::vector<Covering>& coverings) const {
    BorderSearch borders(surfaces_, camera, T_c_w, visible);
    coverings.clear();
    borders.search(Axis::row, coverings);
    borders.search(Axis::column, coverings);
}

}  // namespace photonav
