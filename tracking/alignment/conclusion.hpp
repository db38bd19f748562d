// SPDX-License-Identifier: BSD-3-Clause
// The statistics, covariance and verdict of an alignment from its last iterate.
#pragma once

#include <optional>

#include "alignment/coarse_to_fine.hpp"

namespace photonav {

/// The last iterate of an alignment.
struct LastIterate {
    NormalEquations equations;
    std::size_t pixels = 0;             ///< largest number of pixels that could be used
    MeasuredInformation image = {};     ///< information of the image about the pose
    double finer = 0.;                  ///< see ResidualStatistics
    std::optional<Matrix6> prior = {};  ///< covariance of the prior, transported() to the iterate
};

/// Completes an alignment whose pose, exposure and convergence are known: statistics, information,
/// covariance and verdict.
void conclude(Alignment& alignment, const LastIterate& last, const AlignmentOptions& options);

}  // namespace photonav
