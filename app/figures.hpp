// SPDX-License-Identifier: BSD-3-Clause
// The figures of a run as PNG pictures, and the plain things that figures and report page draw.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "canvas.hpp"
#include "pictures.hpp"
#include "types.hpp"
#include "uncertain_pose.hpp"

namespace photonav {

// Distinguishable with any colour vision, on white and on a grey map.
inline constexpr Color kPathColor{222, 79, 12};
inline constexpr Color kBaselineColor{28, 108, 214};
inline constexpr Color kTreeColor{38, 140, 122};

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
    Color color = kPathColor;
    std::vector<PathPoint> points;
};

using Edge = std::array<Eigen::Vector3f, 2>;  ///< end points in w [m]

struct DrawnTree {
    std::string name = "search tree";
    Color color = kTreeColor;
    std::vector<Edge> edges;
    bool isOnTop = false;  ///< drawn over the paths, and stronger: what was flown
};

/// Start, goal, paths and tree from above, over the grey values of the floor or map.
struct TopView {
    std::string title = {};
    Eigen::AlignedBox2d area = {};  ///< what is drawn, x and y in w [m]
    ImageF background = {};  ///< grey values in [0, 1] over `area`: first row at the largest y,
                             ///< first column at the smallest x; may be empty
    std::vector<DrawnTree> trees = {};
    std::vector<DrawnPath> paths = {};  ///< the first one is drawn on top, of those that run
                                        ///< along it the lower ones wider
    Eigen::Vector3d start = Eigen::Vector3d::Zero();
    Eigen::Vector3d goal = Eigen::Vector3d::Zero();  ///< in w
    std::string goalName = "goal";
    double ellipseScale = 1.0;  ///< 3 sigma ellipses of the position are drawn this much larger
                                ///< (the legend says so); 0: none
};

/// @throws std::invalid_argument if the area is empty
Png drawTopView(const TopView& view);

/// Maps without ellipses and legends, in rows.
/// @throws std::invalid_argument if there is none, or an area is empty
Png drawMaps(const std::vector<std::vector<TopView>>& rows);

/// Trace of the pose covariance over the distance along each path.
/// @param logScale decades instead of a linear axis from 0
Png drawTrace(const std::string& title, const std::vector<DrawnPath>& paths, bool logScale);

/// A value per cell of a horizontal grid, for example the information of a view there.
struct HeatMap {
    std::string title = {};
    std::string label = {};  ///< quantity and unit, beside the colour bar; a^b is a superscript
    Eigen::AlignedBox2d area = {};  ///< that the cells fill, x and y in w [m]
    Eigen::ArrayXXd values = {};    ///< (i, j): i-th cell along x, j-th along y, both from the
                                    ///< smallest; not finite: not flyable, drawn hatched
    bool logScale = false;          ///< values <= 0 are drawn as the smallest colour
};

/// @throws std::invalid_argument if the area or the grid is empty
Png drawHeatMap(const HeatMap& map);

}  // namespace photonav
