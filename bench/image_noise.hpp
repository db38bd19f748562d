// SPDX-License-Identifier: BSD-3-Clause
// Random errors of images and poses that benchmarks share.
#pragma once

#include <algorithm>
#include <random>

#include "geometry/types.hpp"
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

/// The image with independent Gaussian noise of standard deviation 0.02 on every pixel.
inline photonav::ImageF independentNoise(const photonav::ImageF& ideal, std::mt19937_64& random) {
    std::normal_distribution<float> noise(0.F, 0.02F);
    photonav::ImageF image = ideal;
    for (unsigned i = 0; i < image.getSize(); ++i) image.bitmap[i] += noise(random);
    return image;
}

/// A twist with independent Gaussian components of the given standard deviations.
inline photonav::Vector6 randomTwist(const photonav::Vector6& sigmas, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    photonav::Vector6 xi;
    for (int i = 0; i < 6; ++i) xi[i] = sigmas[i] * normal(random);
    return xi;
}
