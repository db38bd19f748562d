// SPDX-License-Identifier: BSD-3-Clause
// Trajectories of other programs: TUM and KITTI files, CSV tables and lists of waypoints.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/types.hpp"

namespace photonav {

struct GivenPose {
    std::optional<double> time;  ///< [s]
    Pose T_w_b = Pose::Identity();
};

enum class TrajectoryFormat {
    cameraPoses,  ///< camera to world; TUM: `t tx ty tz qx qy qz qw`, KITTI: rows of the matrix
    table         ///< positions of the body, and perhaps times and headings
};

/// The heading of a table that has none: where the robot flies, or always this one [rad].
using GivenHeading = std::optional<double>;

struct GivenTrajectory {
    TrajectoryFormat format = TrajectoryFormat::table;
    bool hasHeading = false;       ///< the file says how the body is turned
    std::vector<GivenPose> poses;  ///< at least two; times never decrease
};

/// Reads a trajectory. Eight columns without commas are a TUM file, twelve numbers without commas
/// one of KITTI, which has no times. Any other table has columns x,
/// y, z and perhaps t and yaw [s, m, rad], with blanks or commas between them: in the order of the
/// names in its first line, or else x,y,z or t,x,y,z,yaw. Other columns, if they have a name, are
/// passed over.
/// @param T_b_c camera mount, which turns camera poses into body poses
/// @param heading where a table has none; nothing: along the motion from above, as it was before
///        where that is vertical
/// @throws InputError naming file, line and reason: for what is not a finite number, a position
///         beyond 100 km, a quaternion whose norm is not within 0.1 of 1, a decreasing time, four
///         columns without names, fewer than two poses, or poses that are all the same
GivenTrajectory readGivenTrajectory(const std::string& file, const Pose& T_b_c,
                                    const GivenHeading& heading = {});

/// The smallest box around the positions [m].
Eigen::AlignedBox3d boxAround(const GivenTrajectory& trajectory);

}  // namespace photonav
