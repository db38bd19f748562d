// SPDX-License-Identifier: BSD-3-Clause
// Where a planner draws samples after an update: where vertices were removed, and where the map
// changed.
#pragma once

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSampler.h>
#include <ompl/util/RandomNumbers.h>

#include <memory>
#include <vector>

#include "map/map_change.hpp"
#include "space/flight_space.hpp"

namespace photonav {

/// Shares of the samples that are drawn in parts of the space after an update, as long as the space
/// has such parts. The rest is drawn everywhere.
struct SampleShares {
    double removed = 0.;  ///< near vertices that were removed
    double changed = 0.;  ///< where occupancy changed, if the state there is valid
};

/// The parts of a space that an update concerns.
class UpdatedSpace {
  public:
    UpdatedSpace(ompl::base::SpaceInformationPtr si, const FlightSpace& space);

    /// Remembers the state of a vertex that is removed; of many, the latest.
    void addRemoved(const ompl::base::State* state);
    /// Remembers the bricks in which occupancy changed.
    void addChange(const MapChange& change);

    /// Draws a sample in one of the parts, near a removed vertex uniformly within `radius`.
    /// @return whether it did: false for a sample that is to be drawn everywhere
    bool sample(ompl::base::State* state, const SampleShares& shares, double radius,
                ompl::base::StateSampler& sampler, ompl::RNG& rng) const;

    void clear();

  private:
    bool sampleChanged(ompl::base::State* state, ompl::base::StateSampler& sampler,
                       ompl::RNG& rng) const;

    ompl::base::SpaceInformationPtr si_;
    FlightSpace space_;
    std::vector<std::shared_ptr<ompl::base::State>> removed_;  // a ring once it is full
    std::size_t oldest_ = 0;
    std::vector<Eigen::AlignedBox3d> changed_;
};

}  // namespace photonav
