// SPDX-License-Identifier: BSD-3-Clause
#include "figures/perspective.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>

namespace photonav {
namespace {

constexpr unsigned kPictureWidth = 960, kPictureHeight = 660;
constexpr Color kShadow{70, 70, 70};
constexpr double kHeightOfEye = 0.8;     // above the box, over its longer side
constexpr double kSurfaceMargin = 0.1;   // a path this far behind a surface is hidden [m]
constexpr double kPictureMargin = 1.13;  // of the box in the picture, for the labels of the axes
constexpr double kLabelDistance = 26.;   // of the labels from their axis [px]

/// Depth of the first surface below a point, 0 when there is none.
double depthBelow(const ViewSource& world, const Eigen::Vector3d& p_w) {
    Pose T_w_c = Pose::Identity();
    T_w_c.linear() = Eigen::Vector3d(1., -1., -1.).asDiagonal();
    T_w_c.translation() = p_w;
    View view;
    world.render(makeCamera(3, 3, 0.01), T_w_c.inverse(), view);
    return view.depth[1][1];
}

/// Above the corner of least x and y.
Eigen::Vector3d eyeAbove(const Eigen::AlignedBox3d& box) {
    const double height = kHeightOfEye * box.sizes().head<2>().maxCoeff();
    return {box.min().x(), box.min().y(), box.max().z() + height};
}

Pose lookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
    const Eigen::Vector3d z = (target - eye).normalized();
    const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
    Pose T_w_c = Pose::Identity();
    T_w_c.linear() << x, z.cross(x), z;
    T_w_c.translation() = eye;
    return T_w_c.inverse();
}

/// The rectangle around a box in the image plane at depth 1.
Eigen::AlignedBox2d projected(const Eigen::AlignedBox3d& box, const Pose& T_c_w) {
    Eigen::AlignedBox2d image;
    for (int i = 0; i < 8; ++i) {
        const Eigen::Vector3d p =
            T_c_w * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
        if (p.z() > 0.1) image.extend(Eigen::Vector2d(p.head<2>() / p.z()));
    }
    return image;
}

/// T_c_w of a camera at the eye with the box in the middle of its picture.
Pose lookAtMiddle(const Eigen::Vector3d& eye, const Eigen::AlignedBox3d& box) {
    Pose T_c_w = lookAt(eye, box.center());
    for (int i = 0; i < 8; ++i) {
        const Eigen::Vector3d middle = projected(box, T_c_w).center().homogeneous();
        T_c_w = lookAt(eye, T_c_w.inverse() * middle);
    }
    return T_c_w;
}

/// The narrowest camera at T_c_w whose image contains the whole box.
Camera cameraAround(const Eigen::AlignedBox3d& box, const Pose& T_c_w) {
    const Eigen::AlignedBox2d image = projected(box, T_c_w);
    const Eigen::Vector2d half = image.min().cwiseAbs().cwiseMax(image.max().cwiseAbs());
    const double reach = std::max(half.x(), half.y() * kPictureWidth / double{kPictureHeight});
    return makeCamera(kPictureWidth, kPictureHeight,
                      2. * std::atan(std::clamp(kPictureMargin * reach, 0.1, 2.)));
}

/// How bright surfaces are drawn: upright ones darker, by the axis that they face. That is found
/// from points some pixels away, beyond the steps between cells of a map.
class Shading {
  public:
    Shading(const View& view, const Camera& camera, const Pose& T_c_w)
        : view_(view), camera_(camera), T_w_c_(T_c_w.inverse()) {}

    float at(unsigned u, unsigned v) const {
        constexpr unsigned kReach = 4;
        if (u < kReach || v < kReach || u + kReach >= kPictureWidth || v + kReach >= kPictureHeight)
            return 1.F;
        const Eigen::Vector3d down = point(u, v + kReach) - point(u, v - kReach);
        if (std::abs(down.z()) <= down.head<2>().norm()) return 1.F;
        const Eigen::Vector3d right = point(u + kReach, v) - point(u - kReach, v);
        return std::abs(right.x()) > std::abs(right.y()) ? 0.82F : 0.68F;
    }

  private:
    Eigen::Vector3d point(unsigned u, unsigned v) const {
        return T_w_c_ * camera_.unproject(u, v, view_.depth[v][u]);
    }

    const View& view_;
    const Camera& camera_;
    Pose T_w_c_;
};

/// Draws world points into the rendered picture.
class Sketch {
  public:
    Sketch(Plot& plot, const ViewSource& world, const View& view, const Camera& camera,
           const Pose& T_c_w)
        : plot_(plot), world_(world), view_(view), camera_(camera), T_c_w_(T_c_w) {}

    /// The path, thin where something hides it, and its shadow.
    void route(const DrawnPath& path) const {
        Plot::Points shadow, visible, hidden;
        const auto add = [&](Plot::Points& segments, const Eigen::Vector3d& a,
                             const Eigen::Vector3d& b) {
            if ((T_c_w_ * a).z() > 0.1 && (T_c_w_ * b).z() > 0.1)
                segments.insert(segments.end(), {at(a), at(b)});
        };
        for (std::size_t i = 1; i < path.points.size(); ++i) {
            const Eigen::Vector3d& a = path.points[i - 1].position;
            const Eigen::Vector3d& b = path.points[i].position;
            add(shadow, below(a), below(b));
            add(isVisible(0.5 * (a + b)) ? visible : hidden, a, b);
        }
        plot_.segments(shadow, {.color = kShadow, .width = 1.4, .name = "below the paths"});
        plot_.segments(hidden, {.color = path.color, .width = 1.6});
        plot_.segments(visible, {.color = path.color, .width = 4., .name = path.name});
    }

    void stem(const Eigen::Vector3d& p, const Color& color, const std::string& name) const {
        plot_.curve({at(p), at(below(p))}, {.color = kShadow, .width = 1.4});
        plot_.marker(at(p), color, name);
    }

    /// The edge of the floor of a box along x (0) or y (1) on the side of the eye, with ticks.
    void axis(const Eigen::AlignedBox3d& box, int along) const {
        Eigen::Vector3d end = box.min();
        end[along] = box.max()[along];
        Eigen::Vector3d inside = box.min();
        inside[1 - along] += 0.05 * box.sizes()[1 - along];
        const Plot::Point outward = (at(box.min()) - at(inside)).normalized();
        plot_.segments({at(box.min()), at(end)}, {.width = 1.2});
        const Axis scale{.min = box.min()[along], .max = box.max()[along]};
        for (const Tick& tick : ticksOf(scale, 5)) {
            Eigen::Vector3d p = box.min();
            p[along] = tick.value;
            plot_.segments({at(p), at(p) + 8. * outward}, {.width = 1.2});
            plot_.text(at(p) + kLabelDistance * outward, tick.label);
        }
        plot_.text(at(0.5 * (box.min() + end)) + 2.2 * kLabelDistance * outward,
                   along == 0 ? "x [m]" : "y [m]");
    }

  private:
    Plot::Point at(const Eigen::Vector3d& p_w) const { return camera_.project(T_c_w_ * p_w); }

    bool isVisible(const Eigen::Vector3d& p_w) const {
        const Eigen::Vector2d p = at(p_w).array().round();
        if (p.x() < 0. || p.y() < 0. || p.x() >= kPictureWidth || p.y() >= kPictureHeight)
            return true;
        const float depth = view_.depth[static_cast<unsigned>(p.y())][static_cast<unsigned>(p.x())];
        return depth <= 0.F || (T_c_w_ * p_w).z() < depth + kSurfaceMargin;
    }

    Eigen::Vector3d below(const Eigen::Vector3d& p_w) const {
        return p_w - depthBelow(world_, p_w) * Eigen::Vector3d::UnitZ();
    }

    Plot& plot_;
    const ViewSource& world_;
    const View& view_;
    const Camera& camera_;
    const Pose& T_c_w_;
};

Picture shaded(const View& view, const Shading& shading) {
    Picture picture{{}, kPictureWidth};
    for (unsigned i = 0; i < view.intensity.getSize(); ++i) {
        const float grey = std::clamp(view.intensity.bitmap[i], 0.F, 1.F) *
                           shading.at(i % kPictureWidth, i / kPictureWidth);
        picture.pixels.push_back(view.depth.bitmap[i] > 0.F ? greyColor((70. + 170. * grey) / 255.)
                                                            : kWhite);
    }
    return picture;
}

}  // namespace

Figure perspectiveFigure(const ViewSource& world, const Perspective& perspective) {
    const Eigen::AlignedBox3d& box = perspective.box;
    const Pose T_c_w = lookAtMiddle(eyeAbove(box), box);
    const Camera camera = cameraAround(box, T_c_w);
    View view;
    world.render(camera, T_c_w, view);
    Plot plot = Plot::image(shaded(view, {view, camera, T_c_w}), kPictureWidth, true);
    const Sketch sketch(plot, world, view, camera, T_c_w);
    for (const int along : {0, 1}) sketch.axis(box, along);
    for (auto path = perspective.paths.rbegin(); path != perspective.paths.rend(); ++path) {
        sketch.route(*path);
        if (path->points.empty()) continue;
        const bool isFirst = path == std::prev(perspective.paths.rend());  // of one legend
        sketch.stem(path->points.front().position, kStartColor, isFirst ? "start" : "");
        sketch.stem(path->points.back().position, kGoalColor, isFirst ? "goal" : "");
    }
    return {perspective.title, {{plot}}};
}

}  // namespace photonav
