// SPDX-License-Identifier: BSD-3-Clause
// Whether a camera that flies a given trajectory can be localised all along it.
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
    int headings = 24;  ///< compared at every place, evenly spread; 0: none
    /// Standard deviation of the position along its weakest direction above which the camera counts
    /// as lost [m]; none: what the tracker's search covers.
    std::optional<double> maxSigma = {};
};

/// Why the camera is lost at a place.
enum class LossCause {
    none,
    rejectedImages,  ///< several images in a row show too little of the map (LossOptions)
    wideBelief,      ///< the tracker's search does not cover the belief (searchSpacing())
    maxSigma         ///< more uncertain than asked for
};
std::string nameOf(LossCause cause);

/// The heading with the least trace after one view from a place, all others compared with it.
struct BestHeading {
    double yaw = 0.;             ///< of the body [rad]
    double trace = 0.;           ///< after a view with this heading
    double ownTrace = 0.;        ///< after a view with the heading of the trajectory
    std::vector<double> traces;  ///< of every heading, from that of the trajectory on, to the left
};

/// A place where an image is taken: the belief, and how the tracker would judge the image.
struct CheckedPlace {
    std::optional<double> time;  ///< [s]
    Pose T_w_b = Pose::Identity();
    double length = 0.;                    ///< way of the position so far [m]
    double distance = 0.;                  ///< the same with turns counted [m]
    Matrix6 covariance = Matrix6::Zero();  ///< of T_c_w with the image, left, camera frame
    double traceBefore = 0., trace = 0.;   ///< weighted, without and with the image
    double positionSigma = 0.;             ///< along its weakest direction, with the image [m]
    double rotationSigma = 0.;             ///< about its weakest axis, with the image [rad]
    Eigen::Vector3d weakest_w = Eigen::Vector3d::UnitX();  ///< unit vector, z >= 0
    double overlap = 0.;                           ///< share of the pixels that the map predicts
    Verdict verdict = Verdict::converged;          ///< converged, degenerate or lostOverlap
    std::vector<std::string> openDirections = {};  ///< of the image, see Alignment::openDirections
    LossCause loss = LossCause::none;
    std::optional<BestHeading> best = {};
};

struct CheckedTrajectory {
    std::vector<CheckedPlace> places;
    double length = 0.;              ///< of the positions [m]
    double meanTrace = 0.;           ///< integral of the trace over the distance, divided by it
    double arrivalProbability = 0.;  ///< believed, within `arrivalTolerance` of the last place
    double arrivalTolerance = 0.;    ///< [m]

    /// The first place where the camera is lost; null: none.
    const CheckedPlace* firstLost() const;
    bool isLost() const { return firstLost() != nullptr; }
    /// Way that ends at places where the camera is lost [m].
    double lostLength() const;
    /// The place with the least certain position.
    const CheckedPlace& worst() const;
};

/// Carries the belief of the config along a trajectory, with an image every planner.ds, and judges
/// every image as the tracker of a flight would (flightAlignment(), LossOptions):
///
/// - an image of which the map predicts less than TrustOptions::minOverlap is rejected, and does
///   not count; after LossOptions::rejectedImages of them in a row the camera is lost, until an
///   image determines all directions;
/// - an image that leaves directions open does not lose the camera: odometry goes on there;
/// - where the belief is wider than the tracker's search covers, the camera is lost, and no image
///   counts from there on.
///
/// Views are rendered exactly where the trajectory has them, not at the centres of the planner's
/// cells.
/// @param interrupted the places so far are returned when it is set
/// @throws RenderingStopped when there are none yet, inside a large view
/// @param onProgress share done, in [0, 1]
CheckedTrajectory checkLocalisation(const GivenTrajectory& trajectory, const Config& config,
                                    const World& world, const CheckOptions& options = {},
                                    const std::atomic<bool>& interrupted = kNotInterrupted,
                                    const std::function<void(double)>& onProgress = {});

/// The same positions with the best heading wherever it gains a tenth of the trace.
GivenTrajectory withBestHeadings(const CheckedTrajectory& checked);

}  // namespace photonav
