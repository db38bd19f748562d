// SPDX-License-Identifier: BSD-3-Clause
// Reads trajectories of other programs: TUM and KITTI files, CSV tables and lists of waypoints.
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
    tum,    ///< camera poses T_w_c: `t tx ty tz qx qy qz qw`
    kitti,  ///< camera poses T_w_c, rows of the 3x4 matrix; no times
    csv,    ///< camera poses T_w_c: a table whose names of columns include a quaternion
    table   ///< positions of the body, optionally with times and headings
};

/// The heading for a table without headings [rad]; nothing: along the motion.
using GivenHeading = std::optional<double>;

struct GivenTrajectory {
    TrajectoryFormat format = TrajectoryFormat::table;
    bool hasHeading = false;       ///< the file contains orientations or headings
    std::vector<GivenPose> poses;  ///< at least two; times never decrease
};

/// Reads a trajectory. A file with eight numbers per line without commas is a TUM file, one with
/// twelve is a KITTI file, which has no times. Any other file is a table with the columns x, y, z
/// and optionally t and yaw [m, s, rad], separated by blanks or commas. A first line may name the
/// columns, in a comment if fields are separated by commas; other named columns are ignored.
/// Without names the columns are x,y,z or t,x,y,z,yaw. A table with the columns of a position and a
/// quaternion, named as in TUM's files (tx, qx) or EuRoC's (p_RS_R_x, q_RS_x), has camera poses.
/// Times are nanoseconds if the name of their column says [ns], or beyond 1e16.
/// @param T_b_c camera mount, with which camera poses are converted into body poses
/// @param heading heading of the body for a table without headings; nothing: the horizontal
///        direction of motion (during vertical motion the previous heading)
/// @throws InputError naming file, line and reason: for a value that is not a finite number, a
///         position beyond 100 km, a quaternion whose norm is not within 0.1 of 1, a decreasing
///         time, columns without names other than these, fewer than two poses, poses that are all
///         the same, or a length beyond 100 km
GivenTrajectory readGivenTrajectory(const std::string& file, const Pose& T_b_c,
                                    const GivenHeading& heading = {});

/// The length of the straight motions between the positions [m].
double lengthOf(const GivenTrajectory& trajectory);

/// The bounding box of the positions, world frame [m].
Eigen::AlignedBox3d boxAround(const GivenTrajectory& trajectory);

}  // namespace photonav
