// SPDX-License-Identifier: BSD-3-Clause
#include "planners/updated_space.hpp"

namespace photonav {
namespace ob = ompl::base;
namespace {

constexpr std::size_t kMostRemoved = 20000;  // states remembered
constexpr int kAttempts = 10;                // to find a valid state in changed space

}  // namespace

UpdatedSpace::UpdatedSpace(ob::SpaceInformationPtr si, const FlightSpace& space)
    : si_(std::move(si)), space_(space) {}

void UpdatedSpace::addRemoved(const ob::State* state) {
    std::shared_ptr<ob::State> copy(si_->cloneState(state),
                                    [si = si_](ob::State* s) { si->freeState(s); });
    if (removed_.size() < kMostRemoved) {
        removed_.push_back(std::move(copy));
        return;
    }
    removed_[oldest_] = std::move(copy);
    oldest_ = (oldest_ + 1) % kMostRemoved;
}

void UpdatedSpace::addChange(const MapChange& change) {
    for (const Eigen::Array3i& brick : change.occupancy) {
        const Eigen::AlignedBox3d box = change.boxOf(brick).intersection(space_.bounds());
        if (!box.isEmpty()) changed_.push_back(box);
    }
}

bool UpdatedSpace::sample(ob::State* state, const SampleShares& shares, double radius,
                          ob::StateSampler& sampler, ompl::RNG& rng) const {
    const double removed = removed_.empty() ? 0. : shares.removed;
    const double changed = changed_.empty() ? 0. : shares.changed;
    if (removed + changed == 0.) return false;
    const double dice = rng.uniform01();
    if (dice < removed) {
        const int last = static_cast<int>(removed_.size()) - 1;
        sampler.sampleUniformNear(state, removed_[rng.uniformInt(0, last)].get(), radius);
        return true;
    }
    return dice < removed + changed && sampleChanged(state, sampler, rng);
}

/// The heading, if the state has one, is drawn as everywhere else.
bool UpdatedSpace::sampleChanged(ob::State* state, ob::StateSampler& sampler,
                                 ompl::RNG& rng) const {
    const int last = static_cast<int>(changed_.size()) - 1;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        const Eigen::AlignedBox3d& box = changed_[rng.uniformInt(0, last)];
        Eigen::Vector3d p_w;
        for (int i = 0; i < 3; ++i) p_w[i] = rng.uniformReal(box.min()[i], box.max()[i]);
        sampler.sampleUniform(state);
        space_.setPosition(state, p_w);
        if (si_->isValid(state)) return true;
    }
    return false;
}

void UpdatedSpace::clear() {
    removed_.clear();
    oldest_ = 0;
    changed_.clear();
}

}  // namespace photonav
