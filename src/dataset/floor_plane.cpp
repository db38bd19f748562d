// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/floor_plane.hpp"

#include <cmath>
#include <random>

namespace photonav {
namespace {

struct Plane {
    Eigen::Vector3d normal;
    double offset;  // n . p on the plane
};

std::vector<Eigen::Vector3d> pointsOn(const Plane& plane,
                                      const std::vector<Eigen::Vector3d>& points,
                                      double tolerance) {
    std::vector<Eigen::Vector3d> on;
    for (const Eigen::Vector3d& p : points) {
        if (std::abs(plane.normal.dot(p) - plane.offset) <= tolerance) on.push_back(p);
    }
    return on;
}

/// Least squares of the distances.
Plane fit(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& roughUp) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : points) mean += p / static_cast<double>(points.size());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& p : points) scatter += (p - mean) * (p - mean).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
    Eigen::Vector3d normal = eigen.eigenvectors().col(0);
    if (normal.dot(roughUp) < 0.) normal = -normal;
    return {normal, normal.dot(mean)};
}

}  // namespace

std::optional<Eigen::Vector3d> floorNormal(const std::vector<Eigen::Vector3d>& points,
                                           const Eigen::Vector3d& roughUp,
                                           const FloorOptions& options) {
    if (points.size() < 3) return {};
    std::mt19937 random(options.seed);
    const auto any = [&] { return points[random() % points.size()]; };
    std::vector<Eigen::Vector3d> best;
    for (int trial = 0; trial < options.trials; ++trial) {
        const Eigen::Vector3d a = any();
        Eigen::Vector3d normal = (any() - a).cross(any() - a);
        if (!(normal.norm() > options.tolerance * options.tolerance)) continue;
        normal.normalize();
        if (std::abs(normal.dot(roughUp)) < std::cos(options.maxTilt)) continue;
        auto on = pointsOn({normal, normal.dot(a)}, points, options.tolerance);
        if (on.size() > best.size()) best = std::move(on);
    }
    if (best.size() < 3 || 10 * best.size() < points.size()) return {};
    for (int round = 0; round < 3; ++round) {
        best = pointsOn(fit(best, roughUp), points, options.tolerance);
        if (best.size() < 3) return {};
    }
    return fit(best, roughUp).normal;
}

}  // namespace photonav
