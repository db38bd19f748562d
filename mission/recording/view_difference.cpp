// SPDX-License-Identifier: BSD-3-Clause
#include "recording/view_difference.hpp"

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "evaluation/averages.hpp"

namespace photonav {
namespace {

double meanOf(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.) / static_cast<double>(values.size());
}

}  // namespace

void expose(ImageF& predicted, const Exposure& exposure) {
    for (unsigned i = 0; i < predicted.getSize(); ++i) {
        predicted.bitmap[i] =
            static_cast<float>(exposure.gain * predicted.bitmap[i] + exposure.offset);
    }
}

ViewDifference compareViews(const View& observed, const View& predicted) {
    const unsigned size = observed.intensity.getSize();
    if (predicted.intensity.getSize() != size ||
        predicted.intensity.getWidth() != observed.intensity.getWidth()) {
        throw std::invalid_argument("comparison: views of different size");
    }
    std::vector<float> known;
    std::vector<float> intensity;
    std::vector<float> depth;
    for (unsigned i = 0; i < size; ++i) {
        const float surface = predicted.depth.bitmap[i];
        if (!(surface > 0.F)) continue;
        known.push_back(observed.intensity.bitmap[i]);
        intensity.push_back(std::abs(predicted.intensity.bitmap[i] - observed.intensity.bitmap[i]));
        if (observed.depth.bitmap[i] > 0.F) {
            depth.push_back(std::abs(surface - observed.depth.bitmap[i]));
        }
    }
    ViewDifference difference;
    difference.predicted = size == 0 ? 0. : static_cast<double>(known.size()) / size;
    if (known.empty()) return difference;
    difference.meanIntensity = meanOf(intensity);
    difference.medianIntensity = median(intensity, 0.);
    if (!depth.empty()) {
        difference.meanDepth = meanOf(depth);
        difference.medianDepth = median(depth, 0.);
    }
    const auto typical = static_cast<float>(median(known, 0.));
    for (float& value : known) value = std::abs(value - typical);
    difference.contrast = meanOf(known);
    return difference;
}

}  // namespace photonav
