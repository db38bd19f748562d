// SPDX-License-Identifier: BSD-3-Clause
// Errors of an estimated trajectory and the consistency of its covariances: absolute and relative
// errors (Sturm et al., IROS 2012; Zhang and Scaramuzza, IROS 2018) and NEES.
#pragma once

#include <optional>
#include <vector>

#include "geometry/uncertain_pose.hpp"

namespace photonav {

/// An estimated and a true pose of the same moment.
struct PosePair {
    std::size_t frame = 0;  ///< number in the recording
    double timestamp = 0.;  ///< [s], increasing
    Pose T_w_c_estimate = Pose::Identity();
    Pose T_w_c_truth = Pose::Identity();
};

/// Statistics of non-negative errors.
struct ErrorSummary {
    std::size_t count = 0;
    double rmse = 0., median = 0., p90 = 0., max = 0.;  ///< 0 when there are none
};
ErrorSummary summarise(std::vector<double> errors);

/// Errors of many poses or motions.
struct PoseErrors {
    std::vector<double> translation;  ///< [m]
    std::vector<double> rotation;     ///< angle [rad]
};

/// The motion T with the least sum of squared |T from_i - to_i| (Umeyama 1991, without scale).
/// Where the points do not determine the rotation (fewer than three, or on a line) it is one of the
/// solutions; a single pair gives a translation.
/// @throws std::invalid_argument for lists of different lengths or without points
Pose rigidAlignment(const std::vector<Eigen::Vector3d>& from,
                    const std::vector<Eigen::Vector3d>& to);

/// rigidAlignment() of the estimated positions to the true ones, T_truth_estimate: the alignment of
/// the absolute trajectory error. Near-static or straight flights do not determine its rotation.
Pose positionAlignment(const std::vector<PosePair>& pairs);

/// The alignment T_truth_estimate of positions and orientations. Where the positions do not
/// determine a rotation (their spread across the main direction is less than five times the
/// remaining error), the rotation is the mean of the rotations between the orientations.
Pose alignmentOf(const std::vector<PosePair>& pairs);

/// Absolute errors of all poses, after the estimates were moved by T_truth_estimate: distance of
/// the camera centres and angle between the orientations.
PoseErrors absoluteErrors(const std::vector<PosePair>& pairs,
                          const Pose& T_truth_estimate = Pose::Identity());

enum class Spacing {
    frames,  ///< of the recording
    seconds,
    metres,  ///< of the true path between the poses
};

/// Relative errors of the motions over `delta`: from every pose to the later one whose spacing is
/// nearest to delta, if it differs from delta by at most a tenth. E = (true motion)^-1 (estimated
/// motion), as evo's all_pairs.
PoseErrors relativeErrors(const std::vector<PosePair>& pairs, Spacing spacing, double delta);

/// e^T C^-1 e for the error e = deviation(T_c_w_truth, mean) and the covariance transported() to
/// the truth, 6 on average if the covariance is consistent. Nothing for a covariance that is not
/// positive definite.
std::optional<double> squaredNormalisedError(const UncertainPose& T_c_w, const Pose& T_c_w_truth);

/// Normalised estimation error squared (NEES), divided by the degrees of freedom: 1 on average if
/// covariances are consistent.
struct NormalisedError {
    double pose = 0.;
    double position = 0.;  ///< with the marginal covariance of the position
    double rotation = 0.;
    double largest = 0.;  ///< largest error of the six coordinates, in standard deviations
};
/// Nothing where the covariance is singular.
std::optional<NormalisedError> normalisedError(const UncertainPose& T_c_w, const Pose& T_c_w_truth);

}  // namespace photonav
