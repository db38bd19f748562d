// SPDX-License-Identifier: BSD-3-Clause
// Paths with their beliefs, and trees, as figures and pages draw them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/types.hpp"
#include "geometry/uncertain_pose.hpp"
#include "plot/color.hpp"

namespace photonav {

inline constexpr Color kTreeColor{38, 140, 122};
inline constexpr Color kStartColor{22, 128, 57}, kGoalColor{160, 28, 92};

/// One point of a path: the belief there, reduced to what is drawn.
struct PathPoint {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< camera centre in w [m]
    Pose T_w_c = Pose::Identity();
    double trace = 0.0;  ///< tr_W of the 6x6 covariance [m^2], as in weightedTrace()
    Eigen::Matrix3d positionCovariance = Eigen::Matrix3d::Zero();  ///< of `position`, axes of w
    double distance = 0.0;                                         ///< along the path [m]
    double cost = 0.0;  ///< cost to come, in the planner's unit
};

/// The point of a belief T_c_w (covariance in c, left side, (rho, phi)). To first order the camera
/// centre moves by -R_w_c rho, so its covariance is R_w_c Sigma_rho R_w_c^T.
PathPoint makePathPoint(const UncertainPose& T_c_w, double trace, double distance, double cost);

struct DrawnPath {
    std::string name;  ///< of the planner, for legends
    Color color = kInk;
    std::vector<PathPoint> points = {};
};

/// Appends a point and sets its distance along the path.
void append(DrawnPath& path, PathPoint point);

using Edge = std::array<Eigen::Vector3f, 2>;  ///< end points in w [m]

struct DrawnTree {
    std::string name = "search tree";
    Color color = kTreeColor;
    std::vector<Edge> edges = {};
    bool isOnTop = false;  ///< drawn over the paths, and stronger: flights
};

/// Whether most points of a path are nearer than `tolerance` [m] to another one, in x and y.
bool runsAlong(const DrawnPath& path, const DrawnPath& other, double tolerance);

}  // namespace photonav
