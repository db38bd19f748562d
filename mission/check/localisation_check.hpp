// SPDX-License-Identifier: BSD-3-Clause
// Checks whether a camera that flies a given trajectory can be localised everywhere along it.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "alignment/alignment.hpp"
#include "check/given_trajectory.hpp"
#include "config/config.hpp"
#include "problem/planning_problem.hpp"

namespace photonav {

struct CheckOptions {
    int headings = 24;  ///< number of headings compared at every place, evenly spread; 0: none
    /// The camera also counts as lost if the standard deviation of its position along the weakest
    /// direction exceeds this value [m]; none: no such limit.
    std::optional<double> maxSigma = {};
};

/// Why the camera is lost at a place.
enum class LossCause {
    none,
    rejectedImages,  ///< several images in a row show too little of the map (LossOptions)
    wideBelief,      ///< the belief is wider than the tracker's search (searchSpacing())
    maxSigma         ///< the position is more uncertain than CheckOptions::maxSigma
};
std::string nameOf(LossCause cause);

/// A comparison of headings at a place by the weighted trace after one view [m^2].
struct BestHeading {
    double yaw = 0.;             ///< heading of the body with the least trace [rad]
    double trace = 0.;           ///< trace after a view with this heading
    double ownTrace = 0.;        ///< trace after a view with the heading of the trajectory
    std::vector<double> traces;  ///< traces for all headings, counterclockwise from the heading of
                                 ///< the trajectory
};

/// A place where an image is taken: the belief, and the tracker's expected verdict on the image.
struct CheckedPlace {
    std::optional<double> time;  ///< [s]
    Pose T_w_b = Pose::Identity();
    double length = 0.;    ///< length of the trajectory so far [m]
    double distance = 0.;  ///< distance so far, including turns (Config::rotationWeight) [m]
    Matrix6 covariance = Matrix6::Zero();  ///< of T_c_w after the image, left, camera frame
    double traceBefore = 0., trace = 0.;   ///< weighted trace before and after the image [m^2]
    double positionSigma = 0.;             ///< along the weakest direction, after the image [m]
    double rotationSigma = 0.;             ///< about the weakest axis, after the image [rad]
    /// Weakest direction of the position, world frame: unit vector, z >= 0.
    Eigen::Vector3d weakest_w = Eigen::Vector3d::UnitX();
    double overlap = 0.;                           ///< share of the pixels that the map predicts
    Verdict verdict = Verdict::converged;          ///< converged, degenerate or lostOverlap
    std::vector<std::string> openDirections = {};  ///< of the image, see Alignment::openDirections
    LossCause loss = LossCause::none;
    std::optional<BestHeading> best = {};  ///< none if no headings are compared
};

struct CheckedTrajectory {
    std::vector<CheckedPlace> places;
    double length = 0.;       ///< length of the trajectory that was checked [m]
    double wholeLength = 0.;  ///< also of the rest that an interruption left out [m]
    double meanTrace = 0.;    ///< weighted trace, averaged over the distance flown [m^2]
    /// Probability, by the belief, that the body ends within arrivalTolerance of the last place.
    double arrivalProbability = 0.;
    double arrivalTolerance = 0.;  ///< [m]

    /// The first place where the camera is lost; null if there is none.
    const CheckedPlace* firstLost() const;
    bool isLost() const { return firstLost() != nullptr; }
    /// Length of the trajectory on which the camera is lost [m]. Each place stands for the stretch
    /// that ends at it.
    double lostLength() const;
    /// The place with the largest positionSigma.
    const CheckedPlace& worst() const;
};

/// The way along a trajectory in steps of planner.ds, with turns counted: about as many places are
/// looked at by checkLocalisation().
double stepsOf(const GivenTrajectory& trajectory, const Config& config);

/// Propagates the initial belief of the config along a trajectory, with an image every planner.ds.
/// Images are evaluated as by the tracker of a flight (flightAlignment(), LossOptions):
///
/// - An image of which the map predicts less than TrustOptions::minOverlap is rejected: it does not
///   update the belief. After LossOptions::rejectedImages rejected images in a row the camera is
///   lost until an image determines all directions.
/// - An image that leaves directions open is used. The camera is not lost: odometry covers the open
///   directions.
/// - When the belief is wider than the tracker's search, the camera is lost, and all later images
///   are ignored.
///
/// Views are rendered at the exact poses of the trajectory, not at the centres of the planner's
/// cells.
/// @param interrupted when it is set, the places so far are returned
/// @param onProgress called with the share done, in [0, 1]
/// @throws Interrupted when it is interrupted inside a large view at the first place
CheckedTrajectory checkLocalisation(const GivenTrajectory& trajectory, const Config& config,
                                    const World& world, const CheckOptions& options = {},
                                    const std::atomic<bool>& interrupted = kNotInterrupted,
                                    const std::function<void(double)>& onProgress = {});

/// The checked positions, with the best heading at all places where it reduces the trace by more
/// than a tenth.
GivenTrajectory withBestHeadings(const CheckedTrajectory& checked);

}  // namespace photonav
