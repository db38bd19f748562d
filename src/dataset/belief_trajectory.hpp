// SPDX-License-Identifier: BSD-3-Clause
// Trajectories with covariances, and their files.
#pragma once

#include <string>
#include <vector>

#include "dataset/trajectory.hpp"
#include "geometry/uncertain_pose.hpp"

namespace photonav {

struct StampedBelief {
    double timestamp = 0.;  ///< [s]
    UncertainPose T_c_w;
};

/// The means, for writeTrajectory().
Trajectory meansOf(const std::vector<StampedBelief>& beliefs);

/// Lines `t s11 s12 ... s16 s22 ... s66`: the 21 elements of the upper triangle by rows, beside a
/// TUM trajectory with the same timestamps. The header states frame, side, order and units.
/// @throws InputError when the file cannot be written
void writeCovariances(const std::string& file, const std::vector<StampedBelief>& beliefs);

/// OpenVINS' lines `t tx ty tz qx qy qz qw Pr11 Pr12 Pr13 Pr22 Pr23 Pr33 Pt11 ... Pt33`, which its
/// ov_eval reads: pose camera to world, covariance of the orientation in the camera frame (to first
/// order phi, on the left of R_c_w), covariance of the position in the world's axes, R_w_c
/// Sigma_rho R_w_c^T. The format has no place for the correlation between the two.
/// @throws InputError when the file cannot be written
void writeOpenVinsTrajectory(const std::string& file, const std::vector<StampedBelief>& beliefs);

}  // namespace photonav
