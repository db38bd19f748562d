// SPDX-License-Identifier: BSD-3-Clause
// Whether a robot whose estimate is at its goal is certain enough to report its arrival.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "estimation/tracked_frame.hpp"

namespace photonav {

/// Least believed probability of an arrival that is reported.
inline constexpr double kArrivalConfidence = 0.995;

/// Where a body is by its belief.
struct PositionBelief {
    Eigen::Vector3d mean_w = Eigen::Vector3d::Zero();      ///< [m]
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< axes of the world [m^2]
};

/// @param T_c_w belief, left, camera frame
PositionBelief bodyPosition(const UncertainPose& T_c_w, const Pose& T_b_c);

/// Believed probability that the position is within `radius` [m] of a place. From 20 000 draws that
/// are the same at every call: within 0.0005 near kArrivalConfidence.
double probabilityWithin(const PositionBelief& position, const Eigen::Vector3d& place_w,
                         double radius);

/// Squared normalised correction of a belief by an image per degree of freedom: 1 on average where
/// the belief before it was consistent. A correction has covariance prior - posterior; only
/// directions count whose variance the image has reduced by a tenth. Nothing where it has reduced
/// none.
std::optional<double> squaredCorrection(const UncertainPose& prior, const UncertainPose& posterior);

/// The corrections by the last images: a test whether the belief is as wide as its errors.
class Corrections {
  public:
    /// An image was tracked; a rejected one corrects nothing.
    void add(const TrackedFrame& frame);

    /// How much larger the variance of a belief should be: the mean squared correction of the last
    /// ten images, at least 1.
    double varianceFactor() const;

  private:
    std::deque<double> last_;
};

/// The belief of a robot whose estimated position is at its goal.
struct BelievedArrival {
    PositionBelief position;  ///< as wide as the corrections by the last images ask for
    double probability = 0.;  ///< to be within the tolerance of the goal
};

/// @param T_c_w belief; @param tolerance distance to the goal of a robot that is there [m]
BelievedArrival believedArrival(const UncertainPose& T_c_w, const Pose& T_b_c,
                                const Corrections& corrections, const Eigen::Vector3d& goal_w,
                                double tolerance);

}  // namespace photonav
