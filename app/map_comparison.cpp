// SPDX-License-Identifier: BSD-3-Clause
#include "map_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "canvas.hpp"

namespace photonav {
namespace {

constexpr Color kNothing{24, 44, 92};
constexpr Color kText{30, 30, 30};
constexpr double kFullDifference = 0.5;  // grey values; brightest colour of the difference

double mean(const std::vector<float>& values) {
    if (values.empty()) return 0.;
    return std::accumulate(values.begin(), values.end(), 0.) / static_cast<double>(values.size());
}

double median(std::vector<float> values) {
    if (values.empty()) return 0.;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Color grey(float intensity) {
    const auto g = static_cast<std::uint8_t>(std::lround(255. * std::clamp(intensity, 0.F, 1.F)));
    return {g, g, g};
}

}  // namespace

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
    difference.meanIntensity = mean(intensity);
    difference.medianIntensity = median(intensity);
    difference.meanDepth = mean(depth);
    difference.medianDepth = median(depth);
    const auto typical = static_cast<float>(median(known));
    for (float& value : known) value = std::abs(value - typical);
    difference.contrast = mean(known);
    return difference;
}

Png comparisonPng(const View& observed, const View& predicted, const std::string& caption) {
    const ViewDifference difference = compareViews(observed, predicted);
    const int columns = static_cast<int>(observed.intensity.getWidth());
    const unsigned size = observed.intensity.getSize();
    std::vector<Color> left(size);
    std::vector<Color> middle(size, kNothing);
    std::vector<Color> right(size, kNothing);
    const auto scale = viridis();
    for (unsigned i = 0; i < size; ++i) {
        const float seen = observed.intensity.bitmap[i];
        left[i] = grey(seen);
        if (!(predicted.depth.bitmap[i] > 0.F)) continue;
        const float expected = predicted.intensity.bitmap[i];
        middle[i] = grey(expected);
        const double share = std::min(std::abs(expected - seen) / kFullDifference, 1.);
        right[i] = scale[static_cast<std::size_t>(255. * share)];
    }
    constexpr double kWidth = 480.;
    constexpr double kGap = 10.;
    constexpr double kHeader = 30.;
    const double height = kWidth * observed.intensity.getHeight() / columns;
    Canvas canvas(3. * kWidth + 4. * kGap, height + kHeader + kGap);
    const auto place = [&](int slot, const std::string& text, const std::vector<Color>& pixels) {
        const double x = kGap + slot * (kWidth + kGap);
        canvas.text(text, {x, kHeader - 9.}, Align::left, kText);
        canvas.picture(pixels, columns, {x, kHeader, kWidth, height}, false);
    };
    place(0, caption, left);
    place(1,
          fmt::format("predicted from the map ({:.0f} % of pixels)", 100. * difference.predicted),
          middle);
    place(2,
          fmt::format("difference (mean {:.3f}; yellow >= {})", difference.meanIntensity,
                      kFullDifference),
          right);
    return canvas.png();
}

}  // namespace photonav
