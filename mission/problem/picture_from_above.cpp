// SPDX-License-Identifier: BSD-3-Clause
#include "problem/picture_from_above.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/camera.hpp"
#include "geometry/convex_polygon.hpp"

namespace photonav {
namespace {

constexpr unsigned kTile = 16;  // edge of the largest tiles [pixels]
/// Scenes have faces at round coordinates. A camera in the plane of a face would see nothing but
/// that plane, so no camera is at round coordinates [pixels].
const Eigen::Vector3d kAside(0.0731, -0.0417, -0.0113);

/// Small tiles, each rendered by a camera right above it, scaled for the lowest surface. What is
/// higher is seen larger and displaced, by less than a pixel in tiles that are small enough.
class ParallelPicture {
  public:
    ParallelPicture(const ViewSource& views, const Eigen::AlignedBox2d& area, double top,
                    double lowest, double pixelSize)
        : views_(views), area_(area), top_(top), depth_(std::max(top - lowest, pixelSize)) {
        const auto pixels = [&](double extent) {
            return std::max(1U, static_cast<unsigned>(std::ceil(extent / pixelSize / kTile))) *
                   kTile;
        };
        picture_.resize(pixels(area.sizes().y()), pixels(area.sizes().x()), 1.F);
        depths_.resize(picture_.getHeight(), picture_.getWidth(), 0.F);
        step_ = area.sizes().array() / Eigen::Array2d(picture_.getWidth(), picture_.getHeight());
        for (unsigned v = 0; v < picture_.getHeight(); v += kTile) {
            for (unsigned u = 0; u < picture_.getWidth(); u += kTile) render(u, v, kTile);
        }
    }

    const ImageF& picture() const { return picture_; }
    const ImageF& depths() const { return depths_; }
    const Eigen::Array2d& step() const { return step_; }

  private:
    /// The square of this edge at a pixel, in four parts if it is too large for what is in it.
    void render(unsigned u, unsigned v, unsigned edge) {
        const Camera camera =
            makeCamera(edge, edge, 2. * std::atan(0.5 * edge * step_.x() / depth_));
        Pose T_w_c = Pose::Identity();  // image right is world x, image down is world -y
        T_w_c.linear() = Eigen::Vector3d(1., -1., -1.).asDiagonal();
        T_w_c.translation() << area_.min().x() + (u + 0.5 * edge) * step_.x(),
            area_.max().y() - (v + 0.5 * edge) * step_.y(), top_;
        T_w_c.translation() += step_.x() * kAside;
        View view;
        views_.render(camera, T_w_c.inverse(), view);
        if (0.5 * edge * (1. - nearest(view.depth) / depth_) > 1.) {
            const unsigned half = edge / 2;
            for (const unsigned row : {v, v + half}) {
                for (const unsigned column : {u, u + half}) render(column, row, half);
            }
            return;
        }
        for (unsigned row = 0; row < edge; ++row) {
            for (unsigned column = 0; column < edge; ++column) {
                const float z = view.depth[row][column];
                depths_[v + row][u + column] = z;
                picture_[v + row][u + column] = z > 0.F ? view.intensity[row][column] : 1.F;
            }
        }
    }

    /// The smallest depth; if there is no surface, that of the lowest one.
    double nearest(const ImageF& depths) const {
        double z = depth_;
        for (unsigned i = 0; i < depths.getSize(); ++i) {
            if (depths.bitmap[i] > 0.F) z = std::min<double>(z, depths.bitmap[i]);
        }
        return z;
    }

    const ViewSource& views_;
    Eigen::AlignedBox2d area_;
    double top_, depth_;   // [m]
    Eigen::Array2d step_;  // edges of a pixel [m]
    ImageF picture_, depths_;
};

/// Darkens the lower side of a step between surfaces, which separates objects of one grey.
void outlineSteps(ImageF& picture, const ImageF& depth) {
    constexpr float kStep = 0.15F, kShade = 0.45F;  // [m], of the brightness
    const auto isStep = [&](float a, float b) { return a > 0.F && b > 0.F && a - b > kStep; };
    for (unsigned v = 1; v + 1 < depth.getHeight(); ++v) {
        for (unsigned u = 1; u + 1 < depth.getWidth(); ++u) {
            const float here = depth[v][u];
            if (isStep(here, depth[v][u - 1]) || isStep(here, depth[v][u + 1]) ||
                isStep(here, depth[v - 1][u]) || isStep(here, depth[v + 1][u]))
                picture[v][u] *= kShade;
        }
    }
}

/// A camera at the height of the cut looks into a solid, whose top is above it.
/// @param corner of the picture: smallest x, largest y
/// @param step edges of a pixel [m]
void fillCut(ImageF& picture, const Prism& solid, const Eigen::Vector2d& corner,
             const Eigen::Array2d& step) {
    constexpr float kCut = 0.3F;
    Eigen::AlignedBox2d box;  // in pixels, v downward
    for (const Eigen::Vector2d& p : solid.footprint) {
        box.extend(
            Eigen::Vector2d((p.x() - corner.x()) / step.x(), (corner.y() - p.y()) / step.y()));
    }
    const Eigen::Array2d size(picture.getWidth(), picture.getHeight());
    const Eigen::Array2i from = box.min().array().max(0.).min(size).floor().cast<int>();
    const Eigen::Array2i to = box.max().array().max(0.).min(size).ceil().cast<int>();
    for (int v = from.y(); v < to.y(); ++v) {
        for (int u = from.x(); u < to.x(); ++u) {
            const Eigen::Vector2d centre(corner.x() + (u + 0.5) * step.x(),
                                         corner.y() - (v + 0.5) * step.y());
            if (isInConvexPolygon(centre, solid.footprint)) picture[v][u] = kCut;
        }
    }
}

}  // namespace

ImageF pictureFromAbove(const ViewSource& views, const Eigen::AlignedBox2d& area, double top,
                        double lowest, double pixelSize, const std::vector<Prism>& solids) {
    const ParallelPicture rendered(views, area, top, lowest, pixelSize);
    ImageF picture = rendered.picture();
    outlineSteps(picture, rendered.depths());
    const Eigen::Vector2d corner(area.min().x(), area.max().y());
    const double middle = 0.5 * (lowest + top);
    for (const Prism& solid : solids) {
        if (solid.low < middle && top <= solid.high) {
            fillCut(picture, solid, corner, rendered.step());
        }
    }
    return picture;
}

}  // namespace photonav
