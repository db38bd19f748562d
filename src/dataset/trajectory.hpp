// SPDX-License-Identifier: BSD-3-Clause
// Camera trajectories and their files (TUM and KITTI, which evo reads).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/types.hpp"
#include "io/text_table.hpp"

namespace photonav {

struct StampedPose {
    double timestamp = 0.;  ///< [s]
    Pose T_w_c = Pose::Identity();
};

using Trajectory = std::vector<StampedPose>;  ///< timestamps never decrease

/// Reads lines `t tx ty tz qx qy qz qw` (camera to world); blank lines and those starting with '#'
/// are skipped, quaternions are normalised.
/// @throws InputError naming the line for a wrong number of fields, a value that is not a finite
///         number, a position beyond 1e8 m, a quaternion whose norm is not within 0.1 of 1, or a
///         decreasing timestamp; also for a missing file and one without poses
/// @param badRows if given, such lines are skipped and their errors appended to it; if more lines
///         are skipped than read, the first error is thrown
Trajectory readTrajectory(const std::string& file, std::vector<InputError>* badRows = nullptr);

/// The pose of one row, with a normalised quaternion. @throws InputError naming the line for a
/// position beyond 1e8 m, and for a quaternion whose norm is not within 0.1 of 1
StampedPose poseOfRow(const TextRow& row, double timestamp, const Eigen::Vector3d& position,
                      const Eigen::Quaterniond& rotation);

/// The trajectory of the rows of any table. `file` is named in errors; `badRows` as in
/// readTrajectory().
Trajectory trajectoryOf(const std::string& file, const std::vector<TextRow>& rows,
                        const std::function<StampedPose(const TextRow&)>& parse,
                        std::vector<InputError>* badRows);

/// The line that readTrajectory() reads: 9 digits per number, 6 decimals for the time.
std::string toLine(const StampedPose& pose);

/// Writes what readTrajectory reads; translations and quaternions with 9 digits.
/// @throws InputError when the file cannot be written
void writeTrajectory(const std::string& file, const Trajectory& trajectory);

/// Reads lines of 12 numbers: the upper three rows of T_w_c, row by row, as in the KITTI odometry
/// benchmark. The file has no times: poses are placed one second apart.
/// @throws InputError as readTrajectory(), and for a matrix that deviates from a rotation by more
///         than 0.01
Trajectory readKittiTrajectory(const std::string& file);

/// Writes what readKittiTrajectory() reads, without the times.
/// @throws InputError when the file cannot be written
void writeKittiTrajectory(const std::string& file, const Trajectory& trajectory);

/// The pose at a time: interpolated (translation linearly, rotation by slerp) between the poses
/// before and after when these are at most `maxGap` apart, else the nearest one within `tolerance`,
/// else nothing. All in seconds.
std::optional<Pose> poseAt(const Trajectory& trajectory, double timestamp, double tolerance,
                           double maxGap);

/// The error to throw if poseAt() finds no pose for any image of a recording.
/// @param first, last time of the first and last image [s]
InputError noPoseNear(const std::string& file, const Trajectory& trajectory, double tolerance,
                      double first, double last);

/// The names worldUpRotation understands: x, y, z, -x, -y, -z.
const std::vector<std::string>& axisNames();

/// Rotation from a recorded world, one of whose axes points up, to a world with z up. y-up and
/// y-down worlds become x forward, y left as seen by a camera of theirs that looks along -z or z.
/// @throws std::invalid_argument for a name that is not among axisNames()
Eigen::Matrix3d worldUpRotation(std::string_view upAxis);

/// As above for any direction `up`: the rotation for the nearest axis, followed by the smallest
/// rotation that makes `up` vertical.
/// @param up unit vector in the recorded world
Eigen::Matrix3d worldUpRotation(const Eigen::Vector3d& up);

}  // namespace photonav
