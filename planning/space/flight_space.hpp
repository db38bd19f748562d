// SPDX-License-Identifier: BSD-3-Clause
// The space that the robot flies in: OMPL state spaces of body poses, bounds, and collision checks
// by clearance.
#pragma once

#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSpace.h>

#include <cstdint>
#include <functional>
#include <string>

#include "geometry/types.hpp"

namespace photonav {

enum class StateKind {
    position,     ///< (x, y, z): heading fixed, as for a downward camera
    positionYaw,  ///< (x, y, z, yaw): near hover, heading free
    se3           ///< full body pose
};

/// A state space of body poses T_w_b, and the conversion between OMPL states and poses.
///
/// The metric is the translation in metres plus `rotationWeight` metres per radian of rotation. It
/// is used for neighbours, for the cost and for the motion noise.
class FlightSpace {
  public:
    /// @param bounds of the position, world frame [m]; with a flat box the height is constant
    /// @param rotationWeight see above [m/rad]
    /// @param fixedHeading yaw of the body for StateKind::position, whose states have none [rad]
    /// @throws std::invalid_argument for empty bounds or a negative weight
    FlightSpace(StateKind kind, const Eigen::AlignedBox3d& bounds, double rotationWeight = 0.25,
                double fixedHeading = 0.);

    StateKind kind() const { return kind_; }
    const ompl::base::StateSpacePtr& space() const { return space_; }
    const Eigen::AlignedBox3d& bounds() const { return bounds_; }

    /// Position of the body in the world frame [m].
    Eigen::Vector3d position(const ompl::base::State* state) const;
    /// T_w_b of a state.
    Pose bodyPose(const ompl::base::State* state) const;
    /// T_w_b after a fraction in [0, 1] of the straight motion between two states.
    Pose poseBetween(const ompl::base::State* from, const ompl::base::State* to,
                     double fraction) const;
    /// Sets position (world frame [m]) and yaw [rad] of a state. The yaw is ignored for
    /// StateKind::position; roll and pitch become 0.
    void setState(ompl::base::State* state, const Eigen::Vector3d& position, double yaw) const;
    /// Sets the position of a state (world frame [m]); its rotation stays.
    void setPosition(ompl::base::State* state, const Eigen::Vector3d& position) const;

    /// Uniform sampler with its own seed, independent of all other random numbers in the process.
    ompl::base::StateSamplerPtr sampler(std::uint32_t seed) const;

    // The connection radius of RRT* depends on the following three values.

    /// Number of dimensions in which the space has an extent, at least 1.
    int dimension() const { return positionDimensions() + rotationDimensions(); }
    /// Volume of the space over these dimensions, in the metric [m^dimension].
    double measure() const;
    /// Volume of the metric's unit ball. It is smaller than the Euclidean ball's, because the
    /// metric is the sum of two distances.
    double unitBallMeasure() const;

  private:
    int positionDimensions() const;
    int rotationDimensions() const;

    StateKind kind_;
    Eigen::AlignedBox3d bounds_;
    double rotationWeight_;
    Eigen::Matrix3d fixedRotation_;  // R_w_b where the state has none
    ompl::base::StateSpacePtr space_;
};

/// Distance from a point in the world frame to the nearest obstacle [m]. Collision checks of
/// motions are as exact as this distance.
using Clearance = std::function<double(const Eigen::Vector3d& p_w)>;

/// OMPL space information for planning. A state is valid if it is within the bounds and its
/// clearance exceeds `radius` [m]. Motions are checked by conservative advancement: each step along
/// the motion is as long as the clearance allows, and at least 5 mm.
ompl::base::SpaceInformationPtr makeSpaceInformation(const FlightSpace& space, Clearance clearance,
                                                     double radius);

}  // namespace photonav
