// SPDX-License-Identifier: BSD-3-Clause
// Where the robot may fly: OMPL state spaces of body poses, bounds, and collision by clearance.
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

/// A state space of body poses T_w_b and the map between OMPL states and poses.
///
/// The metric, used for neighbours, for cost and for noise alike, is metres of translation plus
/// `rotationWeight` metres per radian of rotation.
class FlightSpace {
  public:
    /// @param bounds of the position [m]; a flat box (equal heights) plans at one height
    /// @param fixedHeading yaw of the body where the state has none (StateKind::position) [rad]
    /// @throws std::invalid_argument for empty bounds or a negative weight
    FlightSpace(StateKind kind, const Eigen::AlignedBox3d& bounds, double rotationWeight = 0.25,
                double fixedHeading = 0.);

    StateKind kind() const { return kind_; }
    const ompl::base::StateSpacePtr& space() const { return space_; }
    const Eigen::AlignedBox3d& bounds() const { return bounds_; }

    Eigen::Vector3d position(const ompl::base::State* state) const;
    Pose bodyPose(const ompl::base::State* state) const;
    /// Body pose a fraction in [0, 1] of the straight motion between two states.
    Pose poseBetween(const ompl::base::State* from, const ompl::base::State* to,
                     double fraction) const;
    void setState(ompl::base::State* state, const Eigen::Vector3d& position, double yaw) const;
    /// Moves a state; its rotation stays.
    void setPosition(ompl::base::State* state, const Eigen::Vector3d& position) const;

    /// Uniform sampler with its own seed, independent of all other random numbers in the process.
    ompl::base::StateSamplerPtr sampler(std::uint32_t seed) const;

    /// What the connection radius of RRT* depends on: the number of directions that have an extent,
    /// the volume they span in the metric, and the volume of the metric's unit ball. The ball of a
    /// sum of two distances is smaller than the Euclidean one.
    int dimension() const { return positionDimensions() + rotationDimensions(); }
    double measure() const;
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

/// Distance from a point in the world to the nearest obstacle [m]. The collision check of motions
/// is as exact as this distance.
using Clearance = std::function<double(const Eigen::Vector3d& p_w)>;

/// OMPL space information whose states are valid within the bounds and with more than `radius` of
/// clearance, and whose motions are checked by conservative advancement: the step along the motion
/// is what the clearance allows, and at least 5 mm.
ompl::base::SpaceInformationPtr makeSpaceInformation(const FlightSpace& space, Clearance clearance,
                                                     double radius);

}  // namespace photonav
