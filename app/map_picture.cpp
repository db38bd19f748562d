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

struct Mosaic {
    Eigen::AlignedBox2d area;
    double pixelSize;
    ImageF grey;
    ImageF obliqueness;  ///< squared tangent of the angle to the vertical; kUnseen: nothing here
};

Mosaic emptyMosaic(const Eigen::AlignedBox2d& area) {
    const double pixelSize = area.sizes().maxCoeff() / kPixels;
    const auto pixels = [&](int axis) {
        return std::max(1U, static_cast<unsigned>(std::lround(area.sizes()[axis] / pixelSize)));
    };
    return {area, pixelSize, ImageF(pixels(1), pixels(0), 1.F),
            ImageF(pixels(1), pixels(0), kUnseen)};
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
            if (!(row >= 0.0 && row < mosaic.grey.getHeight() && column >= 0.0 &&
                  column < mosaic.grey.getWidth()))
                continue;
            const auto r = static_cast<unsigned>(row), c = static_cast<unsigned>(column);
            const auto obliqueness = static_cast<float>(x * x + y * y);
            if (obliqueness >= mosaic.obliqueness[r][c]) continue;
            mosaic.obliqueness[r][c] = obliqueness;
            mosaic.grey[r][c] = view.intensity[v][u];
        }
}

/// Gives unseen pixels the mean of the seen ones around them.
void closeGaps(Mosaic& mosaic) {
    const ImageF seen = mosaic.obliqueness, grey = mosaic.grey;
    const int height = static_cast<int>(seen.getHeight()),
              width = static_cast<int>(seen.getWidth());
    for (int r = 0; r < height; ++r)
        for (int c = 0; c < width; ++c) {
            if (seen[r][c] < kUnseen) continue;
            float sum = 0.F, count = 0.F;
            for (int i = std::max(0, r - 1); i <= std::min(height - 1, r + 1); ++i)
                for (int j = std::max(0, c - 1); j <= std::min(width - 1, c + 1); ++j)
                    if (seen[i][j] < kUnseen) {
                        sum += grey[i][j];
                        count += 1.F;
                    }
            if (count == 0.F) continue;
            mosaic.grey[r][c] = sum / count;
            mosaic.obliqueness[r][c] = 0.F;
        }
}

}  // namespace

ImageF pictureFromAbove(const ViewSource& map, const Eigen::AlignedBox2d& area, double height) {
    if (area.isEmpty() || area.sizes().minCoeff() <= 0.0)
        throw std::invalid_argument("pictureFromAbove: the area is empty");
    Mosaic mosaic = emptyMosaic(area);
    const Camera camera = makeCamera(kViewPixels, kViewPixels, kFieldOfView);
    const double spacing = area.sizes().maxCoeff() / kViews;
    View view;
    for (double y = area.min().y() + spacing / 2; y < area.max().y() + spacing / 2; y += spacing)
        for (double x = area.min().x() + spacing / 2; x < area.max().x() + spacing / 2;
             x += spacing) {
            map.render(camera, lookingDown({x, y, height}).inverse(), view);
            addView(mosaic, view, camera, {x, y});
        }
    for (int i = 0; i < 2; ++i) closeGaps(mosaic);
    return mosaic.grey;
}

}  // namespace photonav
