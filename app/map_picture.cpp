// SPDX-License-Identifier: BSD-3-Clause
#include "map_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace photonav {
namespace {

constexpr double kPixels = 400.0;      // along the longer side of the picture
constexpr double kViews = 16.0;        // along the longer side of the area
constexpr unsigned kViewPixels = 160;  // a view's width and height
constexpr double kFieldOfView = 1.3;   // wide: neighbouring views overlap from 0.8 m above [rad]
constexpr float kUnseen = std::numeric_limits<float>::infinity();

using Raster = Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Mosaic {
    Eigen::AlignedBox2d area;
    double pixelSize;
    Raster grey;
    Raster obliqueness;  ///< squared tangent of the angle to the vertical; kUnseen: nothing here
};

Mosaic emptyMosaic(const Eigen::AlignedBox2d& area) {
    const double pixelSize = area.sizes().maxCoeff() / kPixels;
    const auto pixels = [&](int axis) {
        return std::max(1L, std::lround(area.sizes()[axis] / pixelSize));
    };
    return {area, pixelSize, Raster::Constant(pixels(1), pixels(0), 1.F),
            Raster::Constant(pixels(1), pixels(0), kUnseen)};
}

/// Camera at `center`, image right along x, image down against y.
Pose lookingDown(const Eigen::Vector3d& center) {
    Pose T_w_c = Pose::Identity();
    T_w_c.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
    T_w_c.translation() = center;
    return T_w_c;
}

void addView(Mosaic& mosaic, const View& view, const Camera& camera,
             const Eigen::Vector2d& center) {
    for (unsigned v = 0; v < camera.height; ++v)
        for (unsigned u = 0; u < camera.width; ++u) {
            const double depth = view.depth[v][u];
            if (!(depth > 0.0)) continue;
            const double x = (u - camera.cx()) / camera.fx(), y = (v - camera.cy()) / camera.fy();
            const Eigen::Vector2d at = center + depth * Eigen::Vector2d(x, -y);
            const double column = (at.x() - mosaic.area.min().x()) / mosaic.pixelSize;
            const double row = (mosaic.area.max().y() - at.y()) / mosaic.pixelSize;
            if (!(row >= 0.0 && row < static_cast<double>(mosaic.grey.rows()) && column >= 0.0 &&
                  column < static_cast<double>(mosaic.grey.cols())))
                continue;
            const auto r = static_cast<Eigen::Index>(row), c = static_cast<Eigen::Index>(column);
            const auto obliqueness = static_cast<float>(x * x + y * y);
            if (obliqueness >= mosaic.obliqueness(r, c)) continue;
            mosaic.obliqueness(r, c) = obliqueness;
            mosaic.grey(r, c) = view.intensity[v][u];
        }
}

/// Gives unseen pixels the mean of the seen ones around them.
void closeGaps(Mosaic& mosaic) {
    const Raster seen = mosaic.obliqueness, grey = mosaic.grey;
    for (Eigen::Index r = 0; r < seen.rows(); ++r)
        for (Eigen::Index c = 0; c < seen.cols(); ++c) {
            if (seen(r, c) < kUnseen) continue;
            float sum = 0.F, count = 0.F;
            for (auto i = std::max<Eigen::Index>(0, r - 1); i < std::min(seen.rows(), r + 2); ++i)
                for (auto j = std::max<Eigen::Index>(0, c - 1); j < std::min(seen.cols(), c + 2);
                     ++j)
                    if (seen(i, j) < kUnseen) {
                        sum += grey(i, j);
                        count += 1.F;
                    }
            if (count == 0.F) continue;
            mosaic.grey(r, c) = sum / count;
            mosaic.obliqueness(r, c) = 0.F;
        }
}

}  // namespace

ImageF pictureFromAbove(const ViewSource& map, const Eigen::AlignedBox2d& area, double height) {
    if (area.isEmpty() || area.sizes().minCoeff() <= 0.0)
        throw std::invalid_argument("pictureFromAbove: the area is empty");
    Mosaic mosaic = emptyMosaic(area);
    const Camera camera = makeCamera(kViewPixels, kViewPixels, kFieldOfView);
    const double spacing = area.sizes().maxCoeff() / kViews;
    const Eigen::Array2i views = (area.sizes().array() / spacing).ceil().cast<int>();
    View view;
    for (int j = 0; j < views.y(); ++j)
        for (int i = 0; i < views.x(); ++i) {
            const Eigen::Vector2d center =
                area.min().array() + spacing * (Eigen::Array2d(i, j) + 0.5);
            map.render(camera, lookingDown({center.x(), center.y(), height}).inverse(), view);
            addView(mosaic, view, camera, center);
        }
    for (int i = 0; i < 2; ++i) closeGaps(mosaic);

    ImageF picture(static_cast<unsigned>(mosaic.grey.rows()),
                   static_cast<unsigned>(mosaic.grey.cols()));
    std::copy_n(mosaic.grey.data(), mosaic.grey.size(), picture.bitmap);
    return picture;
}

}  // namespace photonav
