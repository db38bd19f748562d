// SPDX-License-Identifier: BSD-3-Clause
#include "flightlog/flight_grids.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/se3.hpp"

namespace photonav {
namespace {

constexpr int kObstaclePixels = 200;  // along the longer side
constexpr int kInformationPixels = 24;
constexpr unsigned kSmaller = 2;    // views of the map than those of the planner
constexpr unsigned kLeastSide = 8;  // of views [pixels]

/// A value of every pixel's centre. The first row is at the largest y.
/// @param pixel edge [m]
template <typename Value>
vpImage<unsigned char> gridOver(const Eigen::AlignedBox2d& area, double pixel, const Value& value) {
    const auto pixels = [&](double length) {
        return static_cast<unsigned>(std::max(1., std::round(length / pixel)));
    };
    const unsigned rows = pixels(area.sizes().y()), columns = pixels(area.sizes().x());
    vpImage<unsigned char> grid(rows, columns);
    for (unsigned v = 0; v < rows; ++v) {
        for (unsigned u = 0; u < columns; ++u) {
            const Eigen::Vector2d share((u + 0.5) / columns, 1. - (v + 0.5) / rows);
            grid[v][u] = value(Eigen::Vector2d(area.min() + share.cwiseProduct(area.sizes())));
        }
    }
    return grid;
}

Pose bodyOf(const ExplorationMoment& moment) {
    return moment.T_c_w.mean.inverse() * moment.planner.config().camera.T_b_c().inverse();
}

}  // namespace

void SeenGround::update(const MapChange& change, double height) {
    if (change.resolution == 0.) return;  // nothing has changed
    if (seen_.empty()) {
        edge_ = MapChange::kBrickEdge * change.resolution;
        first_ = columnOf(area_.min());
        size_ = columnOf(area_.max()) - first_ + 1;
        seen_.resize(static_cast<std::size_t>(size_.prod()));
    }
    for (const Eigen::Array3i& brick : change.occupancy) {
        const Eigen::Array2i at = brick.head<2>() - first_;
        if (brick.z() * edge_ > height || (at < 0).any() || (at >= size_).any()) continue;
        seen_[at.y() * size_.x() + at.x()] = true;
    }
}

/// The bricks above each other in which a place is.
Eigen::Array2i SeenGround::columnOf(const Eigen::Vector2d& p_w) const {
    return (p_w / edge_).array().floor().cast<int>();
}

bool SeenGround::isSeen(const Eigen::Vector2d& p_w) const {
    if (seen_.empty()) return false;
    const Eigen::Array2i at = columnOf(p_w) - first_;
    if ((at < 0).any() || (at >= size_).any()) return false;
    return seen_[at.y() * size_.x() + at.x()];
}

vpImage<unsigned char> obstacleGrid(const ExplorationMoment& moment, const SeenGround& seen,
                                    const Eigen::AlignedBox2d& area) {
    const double cell = moment.map.cells()->getResolution();
    const double pixel = std::max(cell, area.sizes().maxCoeff() / kObstaclePixels);
    const double height = bodyOf(moment).translation().z();
    const double radius = moment.planner.config().robotRadius;
    return gridOver(area, pixel, [&](const Eigen::Vector2d& p_w) {
        const double clearance = moment.planner.clearance({p_w.x(), p_w.y(), height});
        ObstacleLevel level = ObstacleLevel::free;
        if (!seen.isSeen(p_w)) level = ObstacleLevel::unseen;
        if (clearance < radius && level != ObstacleLevel::unseen) level = ObstacleLevel::tooNear;
        if (clearance < std::max(cell, 0.7 * pixel)) level = ObstacleLevel::occupied;
        return static_cast<unsigned char>(level);
    });
}

vpImage<unsigned char> informationGrid(const ExplorationMoment& moment, const SeenGround& seen,
                                       const Eigen::AlignedBox2d& area) {
    const Config& config = moment.planner.config();
    CameraConfig ofViews = config.camera;
    ofViews.width = std::max(kLeastSide, ofViews.width / kSmaller);
    ofViews.height = std::max(kLeastSide, ofViews.height / kSmaller);
    const Camera camera = ofViews.camera();
    PhotometricOptions photometric = config.photometric;
    photometric.scale *= kSmaller * kSmaller;
    const InformationModel information = moment.map.information(camera, photometric);
    const auto views = moment.planner.views();
    const Pose T_b_c = config.camera.T_b_c();
    Pose T_w_b = bodyOf(moment);
    const double height = T_w_b.translation().z();
    T_w_b = levelPose(T_w_b.translation(), yawOf(T_w_b));
    View view;
    const double pixel = area.sizes().maxCoeff() / kInformationPixels;
    return gridOver(area, pixel, [&](const Eigen::Vector2d& p_w) -> unsigned char {
        T_w_b.translation() << p_w, height;
        const bool isFree = moment.planner.clearance(T_w_b.translation()) >= config.robotRadius;
        if (!isFree || !seen.isSeen(p_w)) return kNoInformation;
        views->render(camera, (T_w_b * T_b_c).inverse(), view);
        return informationLevel(information(view).trace());
    });
}

}  // namespace photonav
