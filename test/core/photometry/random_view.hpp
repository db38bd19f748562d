// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <random>

#include "geometry/camera.hpp"
#include "photometry/photometric.hpp"

namespace photonav::test {

/// Uncorrelated grey values and a rough but smooth surface.
inline View randomView(const Camera& camera, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> grey(0.1F, 0.9F);
    View view;
    view.intensity.resize(camera.height, camera.width);
    view.depth.resize(camera.height, camera.width);
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            view.intensity[v][u] = grey(random);
            view.depth[v][u] = 2.F + 0.5F * std::sin(0.1F * u) + 0.4F * std::cos(0.13F * v);
        }
    }
    return view;
}

/// With a row of the Jacobian that is not zero.
inline unsigned countingPixels(const View& view, const Camera& camera) {
    unsigned n = 0;
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            n += pixelJacobian(view, camera, u, v).isZero(0.) ? 0 : 1;
        }
    }
    return n;
}

}  // namespace photonav::test
