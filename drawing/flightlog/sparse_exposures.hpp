// SPDX-License-Identifier: BSD-3-Clause
// Some of the images of a flight: few and small enough to be kept and looked at.
#pragma once

#include <cstddef>
#include <vector>

#include "simulation/simulated_camera.hpp"

namespace photonav {

struct KeptExposure {
    double time = 0.;  ///< [s]
    View view;         ///< image and true depth, at most kShownWidth wide
};

/// Keeps the first exposure, and every n-th from there on; n is doubled whenever there are more
/// than `most`.
class SparseExposures {
  public:
    explicit SparseExposures(std::size_t most = 40) : most_(most) {}

    void add(const Exposed& exposed);

    /// In order of time.
    const std::vector<KeptExposure>& kept() const { return kept_; }

  private:
    std::size_t most_;
    std::size_t stride_ = 1;
    std::size_t added_ = 0;
    std::vector<KeptExposure> kept_;
};

}  // namespace photonav
