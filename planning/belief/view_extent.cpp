// SPDX-License-Identifier: BSD-3-Clause
#include "belief/view_extent.hpp"

#include <algorithm>
#include <cmath>

namespace photonav {
namespace {

constexpr double kPixelMargin = 0.05;  // renderers compute rays in single precision [px]
constexpr double kDepthMargin = 1e-4;  // the same, relative
constexpr double kNearest = 1e-3;      // a box nearer than that has no projection [m]
constexpr float kUnbounded = 1e6F;     // depth of rays without a surface: beyond any map [m]

using Corners = Eigen::Array<double, 1, 8>;

bool isBelow(const Corners& values, double limit) { return values.maxCoeff() < limit; }

/// Tiles that an interval of pixels touches, within [0, count).
std::pair<int, int> tilesOf(double from, double to, unsigned count) {
    const auto tile = [&](double pixel) {
        const double t = std::floor(pixel / ViewExtent::kTile);
        return static_cast<int>(std::clamp(t, 0., static_cast<double>(count - 1)));
    };
    return {tile(from - kPixelMargin), tile(to + kPixelMargin)};
}

}  // namespace

ViewExtent::ViewExtent(const Camera& camera, const ImageF& depth)
    : columns_((camera.width + kTile - 1) / kTile),
      rows_((camera.height + kTile - 1) / kTile),
      depth_(std::size_t(columns_) * rows_, 0.F) {
    std::vector<float> deepest(camera.width);  // by column, within a row of tiles
    for (unsigned v = 0; v < camera.height; ++v) {
        if (v % kTile == 0) std::fill(deepest.begin(), deepest.end(), 0.F);
        const float* row = depth[v];
        for (unsigned u = 0; u < camera.width; ++u) {
            deepest[u] = std::max(deepest[u], row[u] > 0.F ? row[u] : kUnbounded);
        }
        if ((v + 1) % kTile != 0 && v + 1 != camera.height) continue;
        float* tiles = &depth_[std::size_t(v / kTile) * columns_];
        for (unsigned u = 0; u < camera.width; ++u) {
            tiles[u / kTile] = std::max(tiles[u / kTile], deepest[u]);
        }
    }
}

bool ViewExtent::meets(const Camera& camera, const Pose& T_c_w,
                       const Eigen::AlignedBox3d& box_w) const {
    Eigen::Matrix<double, 3, 8> corners_w;
    for (int i = 0; i < 8; ++i) {
        corners_w.col(i) = box_w.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    }
    const Eigen::Matrix<double, 3, 8> corners = T_c_w * corners_w;
    const Corners x = camera.fx() * corners.row(0).array();
    const Corners y = camera.fy() * corners.row(1).array();
    const Corners z = corners.row(2).array();
    if (isBelow(z, 0.)) return false;
    // Beyond one of the planes through the camera and an edge of the image.
    const double right = camera.width - 1 + kPixelMargin - camera.cx();
    const double bottom = camera.height - 1 + kPixelMargin - camera.cy();
    if (isBelow(x + (camera.cx() + kPixelMargin) * z, 0.)) return false;
    if (isBelow(y + (camera.cy() + kPixelMargin) * z, 0.)) return false;
    if (isBelow(right * z - x, 0.) || isBelow(bottom * z - y, 0.)) return false;
    const double nearest = z.minCoeff();
    if (nearest < kNearest) return true;

    const Corners u = camera.cx() + x / z;
    const Corners v = camera.cy() + y / z;
    const auto [left, rightmost] = tilesOf(u.minCoeff(), u.maxCoeff(), columns_);
    const auto [top, lowest] = tilesOf(v.minCoeff(), v.maxCoeff(), rows_);
    const auto depth = static_cast<float>(nearest * (1. - kDepthMargin));
    for (int row = top; row <= lowest; ++row) {
        const float* tiles = &depth_[std::size_t(row) * columns_];
        if (*std::max_element(tiles + left, tiles + rightmost + 1) >= depth) return true;
    }
    return false;
}

Eigen::AlignedBox3d ViewExtent::bounds(const Camera& camera, const Pose& T_c_w) const {
    const Pose T_w_c = T_c_w.inverse();
    Eigen::AlignedBox3d box(T_w_c.translation());
    const auto ray = [&](unsigned tile, double centre, double focal) {
        return (tile * double(kTile) - 1. - centre) / focal;  // a pixel wider to either side
    };
    const double wider = 2.;
    for (unsigned row = 0; row < rows_; ++row) {
        const double top = ray(row, camera.cy(), camera.fy());
        const double bottom = ray(row + 1, camera.cy(), camera.fy()) + wider / camera.fy();
        for (unsigned column = 0; column < columns_; ++column) {
            const double left = ray(column, camera.cx(), camera.fx());
            const double right = ray(column + 1, camera.cx(), camera.fx()) + wider / camera.fx();
            const double z = depth_[std::size_t(row) * columns_ + column] * (1. + kDepthMargin);
            for (const double x : {left, right}) {
                for (const double y : {top, bottom}) {
                    box.extend(T_w_c * Eigen::Vector3d(x * z, y * z, z));
                }
            }
        }
    }
    return box;
}

}  // namespace photonav
