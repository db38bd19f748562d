// SPDX-License-Identifier: BSD-3-Clause
// The outcome of checking a trajectory, and its result.json.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "check/localisation_check.hpp"
#include "check/obstruction.hpp"
#include "flight/flight_set.hpp"

namespace photonav {

/// Input and outcome of a check.
struct CheckOutcome {
    const Config& config;
    World world;
    GivenTrajectory trajectory;
    std::string file;  ///< file of the trajectory
    double tilt = 0.;  ///< largest tilt of the body along the trajectory [rad]
    Obstruction obstruction = {};
    CheckedTrajectory checked = {};
    std::optional<CheckedTrajectory> turned = {};  ///< the trajectory with the best headings
    EvaluatedPath path = {};                       ///< pathOf(checked)
    FlightSet flights = {};
    bool interrupted = false;
};

/// A checked trajectory as a path, for drawing. Cost and information are not set.
EvaluatedPath pathOf(const CheckedTrajectory& checked, const std::string& name);

/// The result in one sentence: the camera stays localised, or it is lost after so many metres, with
/// the cause.
std::string verdictOf(const CheckedTrajectory& checked);

/// Length of the trajectory on which the images are rejected (isRejected) or leave directions open
/// (not isRejected) [m]. Each image stands for the stretch that ends at it.
double lengthByVerdict(const CheckedTrajectory& checked, bool isRejected);

/// Summary and places of a checked trajectory as JSON.
nlohmann::json localisationJson(const CheckedTrajectory& checked);

/// The content of result.json of `photonav check`. The caller must add computation times.
nlohmann::json checkResult(const CheckOutcome& report);

}  // namespace photonav
