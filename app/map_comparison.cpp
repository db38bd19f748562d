// SPDX-License-Identifier: BSD-3-Clause
#include "map_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "averages.hpp"
#include "canvas.hpp"

namespace photonav {
namespace {

constexpr Color kText{30, 30, 30};
constexpr double kFullDifference = 0.5;  // grey values; brightest colour of the difference

double mean(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.) / static_cast<double>(values.size());
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
    if (known.empty()) return difference;
    difference.meanIntensity = mean(intensity);
    difference.medianIntensity = median(intensity, 0.);
    if (!depth.empty()) {
        difference.meanDepth = mean(depth);
        difference.medianDepth = median(depth, 0.);
    }
    const auto typical = static_cast<float>(median(known, 0.));
    for (float& value : known) value = std::abs(value - typical);
    difference.contrast = mean(known);
    return difference;
}

Panel imagePanel(const ImageF& image, const std::string& caption) {
    Panel panel{caption, std::vector<Color>(image.getSize()), static_cast<int>(image.getWidth())};
    std::transform(image.bitmap, image.bitmap + image.getSize(), panel.pixels.begin(), grey);
    return panel;
}

Panel predictedPanel(const View& predicted, const std::string& caption) {
    Panel panel{caption, std::vector<Color>(predicted.intensity.getSize(), kNothingKnown),
                static_cast<int>(predicted.intensity.getWidth())};
    for (unsigned i = 0; i < predicted.intensity.getSize(); ++i) {
        if (predicted.depth.bitmap[i] > 0.F) panel.pixels[i] = grey(predicted.intensity.bitmap[i]);
    }
    return panel;
}

std::vector<Panel> comparisonPanels(const View& observed, const View& predicted,
                                    const std::string& caption) {
    const ViewDifference difference = compareViews(observed, predicted);
    const int columns = static_cast<int>(observed.intensity.getWidth());
    const unsigned size = observed.intensity.getSize();
    Panel right{"nothing is predicted", std::vector<Color>(size, kNothingKnown), columns};
    if (difference.meanIntensity) {
        right.caption = fmt::format("difference (mean {:.3f}; yellow >= {})",
                                    *difference.meanIntensity, kFullDifference);
    }
    const auto scale = viridis();
    for (unsigned i = 0; i < size; ++i) {
        if (!(predicted.depth.bitmap[i] > 0.F)) continue;
        const double error = std::abs(predicted.intensity.bitmap[i] - observed.intensity.bitmap[i]);
        right.pixels[i] =
            scale[static_cast<std::size_t>(255. * std::min(error / kFullDifference, 1.))];
    }
    return {imagePanel(observed.intensity, caption),
            predictedPanel(predicted, fmt::format("predicted there ({:.0f} % of pixels)",
                                                  100. * difference.predicted)),
            right};
}

Png panelsPng(const std::vector<std::vector<Panel>>& rows, double width) {
    constexpr double kGap = 10.;
    constexpr double kHeader = 30.;
    const auto heightOf = [&](const std::vector<Panel>& row) {
        double height = 0.;
        for (const Panel& panel : row) {
            const double lines = static_cast<double>(panel.pixels.size()) / panel.columns;
            height = std::max(height, width * lines / panel.columns);
        }
        return height;
    };
    std::size_t columns = 0;
    double height = kGap;
    for (const auto& row : rows) {
        columns = std::max(columns, row.size());
        height += heightOf(row) + kHeader;
    }
    Canvas canvas(static_cast<double>(columns) * (width + kGap) + kGap, height);
    double top = 0.;
    for (const auto& row : rows) {
        double x = kGap;
        for (const Panel& panel : row) {
            const double lines = static_cast<double>(panel.pixels.size()) / panel.columns;
            canvas.text(panel.caption, {x, top + kHeader - 9.}, Align::left, kText);
            canvas.picture(panel.pixels, panel.columns,
                           {x, top + kHeader, width, width * lines / panel.columns}, false);
            x += width + kGap;
        }
        top += heightOf(row) + kHeader;
    }
    return canvas.png();
}

}  // namespace photonav
