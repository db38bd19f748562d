// SPDX-License-Identifier: BSD-3-Clause
// Keeps a small number of a flight's images, reduced in size, for figures.
#pragma once

#include <cstddef>
#include <vector>

#include "simulation/simulated_camera.hpp"

namespace photonav {

struct KeptExposure {
    double time = 0.;  ///< [s]
    View view;         ///< image and true depth, at most kShownWidth wide
};

/// Keeps the first exposure and every n-th one after it. n is doubled whenever more than `most`
/// exposures are kept.
class SparseExposures {
  public:
    explicit SparseExposures(std::size_t most = 40) : most_(most) {}

    void add(const Exposed& exposed);

    /// The kept exposures, in the order of time.
    const std::vector<KeptExposure>& kept() const { return kept_; }

  private:
    std::size_t most_;
    std::size_t stride_ = 1;
    std::size_t added_ = 0;
    std::vector<KeptExposure> kept_;
};

}  // namespace photonav
