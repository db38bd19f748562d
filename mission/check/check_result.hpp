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

/// What was checked, and what came out.
struct CheckOutcome {
    const Config& config;
    World world;
    GivenTrajectory trajectory;
    std::string file;  ///< of the trajectory
    double tilt = 0.;  ///< of the body, at most [rad]
    Obstruction obstruction = {};
    CheckedTrajectory checked = {};
    std::optional<CheckedTrajectory> turned = {};  ///< with the best headings
    EvaluatedPath path = {};                       ///< of `checked`
    FlightSet flights = {};
    bool interrupted = false;
};

/// A checked trajectory as a path that can be drawn.
EvaluatedPath pathOf(const CheckedTrajectory& checked, const std::string& name);

/// "keeps the camera localised", or where it is lost and why.
std::string verdictOf(const CheckedTrajectory& checked);

/// Way that ends at places whose image is rejected, or leaves directions open [m].
double lengthByVerdict(const CheckedTrajectory& checked, bool isRejected);

/// Everything about the belief along a checked trajectory, place by place.
nlohmann::json localisationJson(const CheckedTrajectory& checked);

/// result.json of `photonav check`; seconds are the caller's to fill.
nlohmann::json checkResult(const CheckOutcome& report);

}  // namespace photonav
