// SPDX-License-Identifier: BSD-3-Clause
// Images to be aligned to room().
#pragma once

#include "tracking/rooms.hpp"

namespace photonav::test {

inline const Camera& camera() {
    static const Camera quarter = makeCamera(188, 120, 70. * std::numbers::pi / 180.);
    return quarter;
}

inline const Pose kPose = lookFrom({1.6, 3., 1.6}, kOblique, 0.1);

inline ImageF observe(const ViewSource& model, const Pose& T_c_w, double sigma = 0.,
                      std::uint64_t seed = 1, const Camera& c = camera()) {
    View view;
    model.render(c, T_c_w, view);
    std::mt19937_64 random(seed);
    return sigma > 0. ? noisy(view.intensity, sigma, random) : view.intensity;
}

}  // namespace photonav::test
