// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <random>

#include "photometry/view.hpp"

/// Adds Gaussian noise to an RGB-D image: 0.02 to the grey values, 0.002 z^2 to the depths z [m].
/// @param scale of all standard deviations; 0 draws the same numbers and adds no noise
inline void addNoise(photonav::View& view, std::mt19937& random, float scale = 1.F) {
    std::normal_distribution<float> noise(0.F, 1.F);
    for (unsigned i = 0; i < view.depth.getSize(); ++i) {
        float& z = view.depth.bitmap[i];
        float& grey = view.intensity.bitmap[i];
        grey = std::clamp(grey + 0.02F * scale * noise(random), 0.F, 1.F);
        if (z > 0.F) z += 0.002F * scale * z * z * noise(random);
    }
}
