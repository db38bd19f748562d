// SPDX-License-Identifier: BSD-3-Clause
// The parts of the space in which a planner draws samples after an update: near removed vertices,
// and where the map changed.
#pragma once

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSampler.h>
#include <ompl/util/RandomNumbers.h>

#include <memory>
#include <vector>

#include "map/map_change.hpp"
#include "space/flight_space.hpp"

namespace photonav {

/// After an update, the shares of the samples that are drawn in parts of the space, if there are
/// such parts. The other samples are drawn in the whole space.
struct SampleShares {
    double removed = 0.;  ///< near vertices that were removed
    double changed = 0.;  ///< where occupancy changed, if a valid state is found there
};

/// The parts of a space that were affected by an update.
class UpdatedSpace {
  public:
    UpdatedSpace(ompl::base::SpaceInformationPtr si, const FlightSpace& space);

    /// Stores a copy of the state of a removed vertex, or of a blocked motion. Only the latest
    /// 20000 are kept.
    void addRemoved(const ompl::base::State* state);
    /// Stores the bricks in which occupancy changed.
    void addChange(const MapChange& change);

    /// Draws a sample in one of the parts; near a removed vertex, uniformly within `radius`.
    /// @return false if no sample was drawn: the caller draws it in the whole space
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
