// SPDX-License-Identifier: BSD-3-Clause
#include "render/rasterizer.hpp"

#include <algorithm>
#include <cstring>

#include "photometry/simd.hpp"

namespace photonav {
namespace {

using simd::Float;
using simd::Int;
using simd::kWidth;

/// A vector of 3-vectors.
struct Float3 {
    Float x, y, z;
};

Float3 operator+(const Float3& a, const Float3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

Float3 cross(const Float3& a, const Float3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Float dot(const Float3& a, const Float3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Float3 rotated(const Eigen::Matrix3f& R, const Float3& p) {
    return {R(0, 0) * p.x + R(0, 1) * p.y + R(0, 2) * p.z,
            R(1, 0) * p.x + R(1, 1) * p.y + R(1, 2) * p.z,
            R(2, 0) * p.x + R(2, 1) * p.y + R(2, 2) * p.z};
}

/// The camera in single precision, with the image's outline as slopes x / z and y / z.
struct Lens {
    explicit Lens(const Camera& camera)
        : fx(static_cast<float>(camera.fx())),
          fy(static_cast<float>(camera.fy())),
          cx(static_cast<float>(camera.cx())),
          cy(static_cast<float>(camera.cy())),
          left((-1.F - cx) / fx),
          right((static_cast<float>(camera.width) - cx) / fx),
          top((-1.F - cy) / fy),
          bottom((static_cast<float>(camera.height) - cy) / fy) {}

    float fx, fy, cx, cy;
    float left, right, top, bottom;  ///< one pixel beyond the outermost pixel centres
};

/// a x + b y + c over the image, one per lane.
struct AffineLanes {
    Float a, b, c;
};

/// @param slack added to the value, relative to the size of its coefficients
AffineLanes inPixels(const Float3& perRay, const Lens& lens, float slack) {
    const Float a = perRay.x / lens.fx;
    const Float b = perRay.y / lens.fy;
    const Float size = simd::abs(perRay.x) + simd::abs(perRay.y) + simd::abs(perRay.z);
    return {a, b, perRay.z - a * lens.cx - b * lens.cy + slack * size};
}

/// The data to draw kWidth triangles.
struct Batch {
    std::array<AffineLanes, 3> edges;
    AffineLanes inverseDepth;
    Float left, right, top, bottom;  ///< bounds in the image [pixel]
};

/// True where all three corners are beyond one of the sides of the field of view, or behind it.
Int outside(const std::array<Float3, 3>& p, const Lens& lens) {
    const auto all = [&](auto&& isOut) { return isOut(p[0]) & isOut(p[1]) & isOut(p[2]); };
    return all([](const Float3& q) { return q.z <= 0.F; }) |
           all([&](const Float3& q) { return q.x < lens.left * q.z; }) |
           all([&](const Float3& q) { return q.x > lens.right * q.z; }) |
           all([&](const Float3& q) { return q.y < lens.top * q.z; }) |
           all([&](const Float3& q) { return q.y > lens.bottom * q.z; });
}

/// Bounds of the projected corners, or the whole image where a corner is not in front.
void setBounds(Batch& batch, const std::array<Float3, 3>& p, const Camera& camera,
               const Lens& lens) {
    constexpr float kNear = 1e-3F;
    const Int inFront = (p[0].z > kNear) & (p[1].z > kNear) & (p[2].z > kNear);
    std::array<Float, 3> x, y;
    for (int i = 0; i < 3; ++i) {
        x[i] = p[i].x / p[i].z * lens.fx + lens.cx;
        y[i] = p[i].y / p[i].z * lens.fy + lens.cy;
    }
    const auto lastColumn = Float{} + static_cast<float>(camera.width - 1);
    const auto lastRow = Float{} + static_cast<float>(camera.height - 1);
    const Float zero{};
    // A hundredth of a pixel covers the rounding.
    batch.left = inFront ? simd::max(simd::min(simd::min(x[0], x[1]), x[2]) - 0.01F, zero) : zero;
    batch.top = inFront ? simd::max(simd::min(simd::min(y[0], y[1]), y[2]) - 0.01F, zero) : zero;
    batch.right = inFront ? simd::min(simd::max(simd::max(x[0], x[1]), x[2]) + 0.01F, lastColumn)
                          : lastColumn;
    batch.bottom =
        inFront ? simd::min(simd::max(simd::max(y[0], y[1]), y[2]) + 0.01F, lastRow) : lastRow;
}

void setCoefficients(Batch& batch, const std::array<Float3, 3>& p, const Float3& edge1,
                     const Float3& edge2, const Lens& lens) {
    // Products with edges instead of corners keep the precision of small, distant triangles.
    const Float3 normal = cross(edge1, edge2);
    const Float inverse = 1.F / dot(normal, p[0]);
    const auto scaled = [&](const Float3& v) -> Float3 {
        return {v.x * inverse, v.y * inverse, v.z * inverse};
    };
    const Float3 edge12{edge2.x - edge1.x, edge2.y - edge1.y, edge2.z - edge1.z};
    // Relative slack: neighbouring triangles overlap a little instead of leaving gaps.
    constexpr float kRounding = 1e-6F;
    batch.edges[0] = inPixels(scaled(cross(p[1], edge12)), lens, kRounding);
    batch.edges[1] = inPixels(scaled(cross(edge2, p[0])), lens, kRounding);
    batch.edges[2] = inPixels(scaled(cross(p[0], edge1)), lens, kRounding);
    batch.inverseDepth = inPixels(scaled(normal), lens, 0.F);
}

/// The image being drawn: nearest triangle so far, and how near.
struct Target {
    VisibilityImage& visible;
    float* inverseDepth;
};

/// Draws lane i of the batch as triangle `id`.
void draw(const Batch& batch, int i, std::uint32_t id, Target& target) {
    struct Line {
        explicit Line(const AffineLanes& f, int lane) : a(f.a[lane]), b(f.b[lane]), c(f.c[lane]) {}
        Float atRow(float y, Float lanes) const { return a * lanes + (b * y + c); }
        float a, b, c;
    };
    const std::array<Line, 3> edges{Line(batch.edges[0], i), Line(batch.edges[1], i),
                                    Line(batch.edges[2], i)};
    const Line inverseDepth(batch.inverseDepth, i);
    const Float lanes = simd::ramp();

    const int firstColumn = static_cast<int>(batch.left[i]) / kWidth * kWidth;
    const int lastColumn = static_cast<int>(batch.right[i]);
    const int lastRow = static_cast<int>(batch.bottom[i]);
    for (int row = static_cast<int>(batch.top[i]); row <= lastRow; ++row) {
        const auto y = static_cast<float>(row);
        std::uint32_t* ids = target.visible.row(row);
        float* nearest = target.inverseDepth + std::ptrdiff_t{row} * target.visible.pitch;
        for (int column = firstColumn; column <= lastColumn; column += kWidth) {
            const Float x = lanes + static_cast<float>(column);
            const Float w = inverseDepth.atRow(y, x);
            Float best;
            Int bestId;
            std::memcpy(&best, nearest + column, sizeof(best));
            std::memcpy(&bestId, ids + column, sizeof(bestId));
            const Int hit = (edges[0].atRow(y, x) >= 0.F) & (edges[1].atRow(y, x) >= 0.F) &
                            (edges[2].atRow(y, x) >= 0.F) & (w > best);
            best = hit ? w : best;
            bestId = hit ? Int{} + static_cast<int>(id) : bestId;
            std::memcpy(nearest + column, &best, sizeof(best));
            std::memcpy(ids + column, &bestId, sizeof(bestId));
        }
    }
}

}  // namespace

Rasterizer::Rasterizer(const std::vector<Triangle>& triangles) : count_(triangles.size()) {
    const std::size_t padded = (count_ + kWidth - 1) / kWidth * kWidth;
    for (auto& values : coordinates_) values.resize(padded);
    for (std::size_t i = 0; i < count_; ++i) {
        const auto& p = triangles[i].corners;
        const std::array<Eigen::Vector3f, 3> vectors{p[0], p[1] - p[0], p[2] - p[0]};
        for (std::size_t k = 0; k < 9; ++k) {
            coordinates_[k][i] = vectors[k / 3][static_cast<Eigen::Index>(k % 3)];
        }
    }
}

void Rasterizer::rasterize(const Camera& camera, const Pose& T_c_w,
                           VisibilityImage& visible) const {
    thread_local std::vector<float> inverseDepth;  // spares an allocation per view
    inverseDepth.assign(visible.ids.size(), 0.F);
    std::fill(visible.ids.begin(), visible.ids.end(), VisibilityImage::kNothing);
    Target target{visible, inverseDepth.data()};

    const Lens lens(camera);
    const Eigen::Matrix3f R = T_c_w.linear().cast<float>();
    const Eigen::Vector3f origin = T_c_w.inverse().translation().cast<float>();
    const auto load = [&](std::size_t vector, std::size_t i) {
        Float3 p;
        std::memcpy(&p.x, &coordinates_[3 * vector][i], sizeof(p.x));
        std::memcpy(&p.y, &coordinates_[3 * vector + 1][i], sizeof(p.y));
        std::memcpy(&p.z, &coordinates_[3 * vector + 2][i], sizeof(p.z));
        return p;
    };
    for (std::size_t first = 0; first < count_; first += kWidth) {
        const Float3 corner = load(0, first);
        const Float3 edge1 = rotated(R, load(1, first));
        const Float3 edge2 = rotated(R, load(2, first));
        const Float3 p0 =
            rotated(R, {corner.x - origin.x(), corner.y - origin.y(), corner.z - origin.z()});
        const std::array<Float3, 3> p{p0, p0 + edge1, p0 + edge2};
        const Int hidden = outside(p, lens);
        Batch batch;
        bool ready = false;
        for (int i = 0; i < kWidth && first + i < count_; ++i) {
            if (hidden[i]) continue;
            if (!ready) {
                setBounds(batch, p, camera, lens);
                setCoefficients(batch, p, edge1, edge2, lens);
                ready = true;
            }
            draw(batch, i, static_cast<std::uint32_t>(first + i), target);
        }
    }
}

}  // namespace photonav
