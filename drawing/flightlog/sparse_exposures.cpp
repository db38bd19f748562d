// SPDX-License-Identifier: BSD-3-Clause
#include "flightlog/sparse_exposures.hpp"

#include <utility>

#include "recording/halved_view.hpp"

namespace photonav {

void SparseExposures::add(const Exposed& exposed) {
    if (added_++ % stride_ != 0) return;
    View view{exposed.image, exposed.depth};
    halve(view, halvingsToShow(view.intensity.getWidth()));
    kept_.push_back({exposed.time, std::move(view)});
    if (kept_.size() <= most_) return;
    std::vector<KeptExposure> fewer;
    for (std::size_t i = 0; i < kept_.size(); i += 2) fewer.push_back(std::move(kept_[i]));
    kept_ = std::move(fewer);
    stride_ *= 2;
}

}  // namespace photonav
