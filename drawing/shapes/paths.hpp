// SPDX-License-Identifier: BSD-3-Clause
// Paths with their beliefs, and trees, for figures and pages.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geometry/types.hpp"
#include "geometry/uncertain_pose.hpp"
#include "plot/color.hpp"

namespace photonav {

inline constexpr Color kTreeColor{38, 140, 122};
inline constexpr Color kStartColor{22, 128, 57}, kGoalColor{160, 28, 92};

/// One point of a path with the parts of its belief that are drawn.
struct PathPoint {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< camera centre, world frame [m]
    Pose T_w_c = Pose::Identity();
    double trace = 0.0;                      ///< weightedTrace() of the 6x6 covariance [m^2]
    std::optional<double> traceBefore = {};  ///< before the image at the point; none: not known
    /// Covariance of `position`, world frame [m^2].
    Eigen::Matrix3d positionCovariance = Eigen::Matrix3d::Zero();
    double distance = 0.0;  ///< length of the path up to the point [m]
    double cost = 0.0;      ///< cost-to-come [m]
};

/// The point of a belief of T_c_w (covariance in the camera frame, left perturbation, order
/// (rho, phi)). To first order the camera centre moves by -R_w_c rho, so that its covariance is
/// R_w_c Sigma_rho R_w_c^T.
PathPoint makePathPoint(const UncertainPose& T_c_w, double trace, double distance, double cost);

struct DrawnPath {
    std::string name;  ///< name in legends, usually the planner's
    Color color = kInk;
    std::vector<PathPoint> points = {};
    /// Mean of the trace over the length, with the beliefs between the points [m^2]; none: not
    /// known.
    std::optional<double> meanTrace = {};
};

/// Appends a point and sets its distance along the path.
void append(DrawnPath& path, PathPoint point);

using Edge = std::array<Eigen::Vector3f, 2>;  ///< end points, world frame [m]

struct DrawnTree {
    std::string name = "search tree";
    Color color = kTreeColor;
    std::vector<Edge> edges = {};
    bool isOnTop = false;  ///< drawn over the paths with thicker lines, as for flights
};

/// Whether more than half of the points of a path are nearer than `tolerance` [m] to another path,
/// in x and y.
bool runsAlong(const DrawnPath& path, const DrawnPath& other, double tolerance);

}  // namespace photonav
