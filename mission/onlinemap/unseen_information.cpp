// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/unseen_information.hpp"

#include <algorithm>
#include <utility>

namespace photonav {
namespace {

constexpr double kLeastKnown = 0.5;  // share of a view that stands for its surroundings
constexpr int kRemembered = 20;      // views: farther back, the scene may have been another

double shareKnown(const View& view) {
    const ImageF& depth = view.depth;
    if (depth.getSize() == 0) return 1.;  // of a map that has no depth, nothing is known to lack
    const auto known = std::count_if(depth.bitmap, depth.bitmap + depth.getSize(),
                                     [](float z) { return z > 0.F; });
    return static_cast<double>(known) / depth.getSize();
}

}  // namespace

void UnseenInformation::observe(const View& shown, const Matrix6& information) {
    const double known = shareKnown(shown);
    if (known < kLeastKnown) return;
    views_ = std::min(views_ + 1, kRemembered);
    *expected_ += (information / known - *expected_) / views_;
}

InformationModel UnseenInformation::complete(InformationModel model) const {
    return [model = std::move(model), expected = expected_](const View& view) -> Matrix6 {
        return model(view) + (1. - shareKnown(view)) * *expected;
    };
}

}  // namespace photonav
