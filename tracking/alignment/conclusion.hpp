// SPDX-License-Identifier: BSD-3-Clause
// What follows from the last iterate of an alignment.
#pragma once

#include <optional>

#include "alignment/coarse_to_fine.hpp"

namespace photonav {

struct LastIterate {
    NormalEquations equations;
    std::size_t pixels = 0;             ///< that could count
    MeasuredInformation image = {};     ///< about the pose
    double finer = 0.;                  ///< see ResidualStatistics
    std::optional<Matrix6> prior = {};  ///< its covariance, transported() to the iterate
};

/// Completes an alignment whose pose, exposure and convergence are known: statistics, information,
/// covariance and verdict.
void conclude(Alignment& alignment, const LastIterate& last, const AlignmentOptions& options);

}  // namespace photonav
