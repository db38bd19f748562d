// SPDX-License-Identifier: BSD-3-Clause
// A study of photometric servoing at a goal: basin of convergence, rate of convergence and slowest
// directions.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "control/levenberg_servo.hpp"

namespace photonav {

struct ServoStudyOptions {
    bool hasTilt = false;   ///< true: six degrees of freedom; false: x, y, z, yaw, as for a MAV
    double gain = 1.;       ///< gain of the control law [1/s]
    double damping = 0.01;  ///< mu of LevenbergServo
    double rate = 10.;      ///< images and velocity commands per second [1/s]
    double duration = 20.;  ///< longest duration of a trial [s]
    std::vector<double> distances{0.1, 0.2, 0.4, 0.8};  ///< distances of starts from the goal [m]
    std::vector<double> angles{0., 10., 20.};  ///< rotations of starts from the goal [degrees]
    int trials = 10;                           ///< trials per pair of distance and angle
    unsigned seed = 1;
};

/// The goal, the scene around it, and the camera.
struct ServoGoal {
    const ViewSource& views;  ///< renders the scene; must outlive the study
    Camera camera = {};
    Pose T_b_c = Pose::Identity();  ///< camera mount
    Pose T_w_b = Pose::Identity();  ///< pose of the body at the goal
    PhotometricOptions photometric = {};
};

/// A mode of the linearised servo: an offset in its direction decays exponentially, at its rate.
struct ServoMode {
    /// Body twist (x, y, z, roll, pitch, yaw) in the body's axes, scaled so that
    /// |rho| + depth |phi| = 1.
    Vector6 direction = Vector6::Zero();
    double rate = 0.;  ///< predicted rate in continuous time [1/s]; 0: the offset does not decay
    /// Decay rates in discrete time, at the image rate of the study [1/s]: the first-order
    /// prediction, and the simulation without noise from a small offset in this direction.
    double predictedDecay = 0., simulatedDecay = 0.;
};

/// The trials that start at one distance and angle from the goal.
struct BasinCell {
    double distance = 0., angle = 0.;  ///< [m], [degrees]
    int trials = 0, converged = 0;
    double low = 0., high = 1.;  ///< 95 % interval of the share of trials that converge (Wilson)
    double seconds = 0.;         ///< median time to converge [s]; 0: no trial converged
};

struct ServoStudy {
    double depth = 1.;  ///< median depth of the view at the goal [m]; 1 rad counts as this length
    double condition = 0.;  ///< condition number of H, rotations scaled by the depth; infinite: H
                            ///< is singular
    /// Standard deviations of the body's pose from one image at the goal (inverse of the
    /// information): along the weakest direction [m] and about the weakest axis [rad]. Infinite if
    /// a direction is open.
    double positionSigma = 0., rotationSigma = 0.;
    std::vector<ServoMode> modes;  ///< slowest mode first
    std::vector<BasinCell> basin;
    bool interrupted = false;

    /// Number of directions that the view at the goal does not determine (modes of rate 0).
    std::size_t openDirections() const;
    /// Number of trials in all cells of the basin.
    int trials() const;
    /// Number of trials that converged, in all cells of the basin.
    int converged() const;
};

/// A trial has converged when the body stays within these distances of the goal for five images.
inline constexpr double kServoPosition = 0.01;  // [m]
inline constexpr double kServoAngle = 0.01;     // [rad]

/// Linearises the servo at the goal and simulates trials from many starts. Images have independent
/// noise with the sigma of ServoGoal::photometric. Starts lie in random directions that depend on
/// the seed, not on the goal. Collisions are not modelled. An interruption drops the trial in
/// progress.
/// @param progress called after each cell of the basin with the share done, in (0, 1]
/// @throws Interrupted when interrupted before the first trial
ServoStudy studyServo(const ServoGoal& goal, const ServoStudyOptions& options,
                      const std::atomic<bool>& interrupted,
                      const std::function<void(double share)>& progress);

/// The two largest components of a mode's direction: "x +60 %, pitch -25 %", or "x" alone. The
/// first is positive, because the direction has no sign; rotations count after multiplication with
/// the depth [m].
std::string inWords(const ServoMode& mode, double depth);

}  // namespace photonav
