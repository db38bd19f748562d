// SPDX-License-Identifier: BSD-3-Clause
#include "figures/problem_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/constants.hpp"
#include "geometry/se3.hpp"

namespace photonav {
namespace {

constexpr double kPicturePixel = 0.025;     // of the top view's background [m]
constexpr double kMaxPicturePixels = 800.;  // along its longer side

UncertainPose belief(const BeliefPoint& point, const Pose& T_b_c) {
    return {(point.T_w_b * T_b_c).inverse(), point.covariance};
}

}  // namespace

Eigen::AlignedBox2d areaOf(const Config& config) {
    Eigen::AlignedBox2d area(config.bounds.min().head<2>(), config.bounds.max().head<2>());
    area.min().array() -= config.robotRadius;
    area.max().array() += config.robotRadius;
    return area;
}

std::string placeText(const Config& config, double height, double yaw) {
    if (config.space == StateKind::position) return fmt::format("{:.2f} m", height);
    return fmt::format("{:.2f} m, heading {:.0f} deg", height, yaw / kDegree);
}

DrawnPath drawnPath(const EvaluatedPath& path, const Pose& T_b_c) {
    DrawnPath result{path.planner, plannerColor(path.planner), {}, path.meanTrace};
    for (const BeliefPoint& point : path.points) {
        result.points.push_back(
            makePathPoint(belief(point, T_b_c), point.trace, point.length, point.cost));
        result.points.back().traceBefore = point.traceBefore;
    }
    return result;
}

TopView viewFromAbove(const Config& config, const World& world,
                      const std::vector<DrawnPath>& paths) {
    TopView view;
    view.area = areaOf(config);
    const double pixel = std::max(kPicturePixel, view.area.sizes().maxCoeff() / kMaxPicturePixels);
    view.background = world.pictureFromAbove(view.area, config.bounds.max().z(), pixel);
    view.paths = paths;
    view.ellipseScale = readableEllipseScale(paths, view.area.sizes().maxCoeff());
    if (config.space != StateKind::position) view.horizontalFov = config.camera.hfov * kDegree;
    view.start = config.start.position;
    view.goal = config.goal.position;
    return view;
}

Eigen::ArrayXXd viewGrid(PlanningProblem& problem, const Eigen::AlignedBox2d& area, double height,
                         double yaw, int cells, const std::function<double(const Matrix6&)>& value,
                         const std::function<void(double)>& onProgress) {
    const double step = area.sizes().maxCoeff() / cells;
    const int nx = std::max(1, static_cast<int>(std::lround(area.sizes().x() / step)));
    const int ny = std::max(1, static_cast<int>(std::lround(area.sizes().y() / step)));
    Eigen::ArrayXXd values =
        Eigen::ArrayXXd::Constant(nx, ny, std::numeric_limits<double>::quiet_NaN());
    Pose T_w_b = levelPose(Eigen::Vector3d::Zero(), yaw);
    for (int i = 0; i < nx; ++i) {
        for (int j = 0; j < ny; ++j) {
            T_w_b.translation() << area.min().x() + (i + 0.5) * area.sizes().x() / nx,
                area.min().y() + (j + 0.5) * area.sizes().y() / ny, height;
            if (problem.isFlyable(T_w_b.translation())) {
                values(i, j) = value(problem.informationAt(T_w_b));
            }
        }
        if (onProgress) onProgress((i + 1.) / nx);
    }
    return values;
}

}  // namespace photonav
