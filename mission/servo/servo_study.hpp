// SPDX-License-Identifier: BSD-3-Clause
// Photometric servoing at a goal: from how far it converges, how fast, and in which direction
// slowest.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "control/levenberg_servo.hpp"

namespace photonav {

struct ServoStudyOptions {
    bool hasTilt = false;   ///< six degrees of freedom; false: x, y, z, yaw, as a MAV's
    double gain = 1.;       ///< [1/s]
    double damping = 0.01;  ///< mu of LevenbergServo
    double rate = 10.;      ///< images a second
    double duration = 20.;  ///< that a trial may last [s]
    std::vector<double> distances{0.1, 0.2, 0.4, 0.8};  ///< of starts from the goal [m]
    std::vector<double> angles{0., 10., 20.};           ///< and their rotations [degrees]
    int trials = 10;                                    ///< of each pair
    unsigned seed = 1;
};

/// What there is at a goal.
struct ServoGoal {
    const ViewSource& views;  ///< must outlive the study
    Camera camera = {};
    Pose T_b_c = Pose::Identity();
    Pose T_w_b = Pose::Identity();  ///< of the body at the goal
    PhotometricOptions photometric = {};
};

/// A direction that converges at a rate of its own.
struct ServoMode {
    Vector6 direction = Vector6::Zero();  ///< body twist (x, y, z, roll, pitch, yaw) in the body's
                                          ///< axes; |rho| + depth |phi| = 1
    double rate = 0.;                     ///< predicted, continuous in time [1/s]; 0: never
    /// Of a servo without noise from a small offset in this direction, in discrete time as the
    /// study runs it: by the first-order prediction, and simulated [1/s].
    double predictedDecay = 0., simulatedDecay = 0.;
};

struct BasinCell {
    double distance = 0., angle = 0.;  ///< [m], [degrees]
    int trials = 0, converged = 0;
    double low = 0., high = 1.;  ///< 95 % interval of the share that converges (Wilson)
    double seconds = 0.;         ///< median time to converge; 0: none did
};

struct ServoStudy {
    double depth = 1.;      ///< median of the goal's view [m]; makes rotations comparable
    double condition = 0.;  ///< of H, rotations times the depth; infinite: singular
    /// Of the body's pose from one image at the goal (the inverse of its information), along the
    /// weakest direction and about the weakest axis [m], [rad]; infinite: a direction is open.
    double positionSigma = 0., rotationSigma = 0.;
    std::vector<ServoMode> modes;  ///< the slowest first
    std::vector<BasinCell> basin;
    bool interrupted = false;

    /// Directions that the goal's view does not show: they never converge.
    std::size_t openDirections() const;
    /// Of all trials.
    int trials() const;
    int converged() const;
};

/// A trial has converged when it is within these of the goal.
inline constexpr double kServoPosition = 0.01;  // [m]
inline constexpr double kServoAngle = 0.01;     // [rad]

/// Images have the noise of ServoGoal::photometric. Trials start in random directions, the same
/// ones for the same seed whatever the goal; nothing stands in their way.
ServoStudy studyServo(const ServoGoal& goal, const ServoStudyOptions& options,
                      const std::atomic<bool>& interrupted,
                      const std::function<void(double share)>& progress);

/// A direction in words: "x and pitch (0.9, 0.4)": parts above a third of the largest.
std::string inWords(const ServoMode& mode, double depth);

}  // namespace photonav
