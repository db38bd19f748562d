// SPDX-License-Identifier: BSD-3-Clause
#include "figures/convergence_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "evaluation/averages.hpp"

namespace photonav {
namespace {

constexpr std::size_t kMaxRows = 5;
constexpr double kFullError = 0.1;  // brightest colour of the relative error
constexpr std::array<Color, 3> kStateColors{{{205, 205, 205}, {38, 140, 122}, kWine}};

CaptionedImage emptyImage(const ImageF& shape) {
    return {
        {},
        {std::vector<Color>(shape.getSize(), kUnknownColor), static_cast<int>(shape.getWidth())}};
}

/// Colours from the 5th to the 95th percentile of depth.
CaptionedImage depthImage(const ImageF& depth) {
    CaptionedImage image = emptyImage(depth);
    std::vector<float> known;
    std::copy_if(depth.bitmap, depth.bitmap + depth.getSize(), std::back_inserter(known),
                 [](float z) { return z > 0.F; });
    if (known.empty()) {
        image.caption = "no depth found";
        return image;
    }
    std::sort(known.begin(), known.end());
    const double near = known[known.size() / 20];
    const double far = known[known.size() - 1 - known.size() / 20];
    for (unsigned i = 0; i < depth.getSize(); ++i) {
        const double z = depth.bitmap[i];
        if (z > 0.) image.picture.pixels[i] = viridis((z - near) / std::max(far - near, 1e-6));
    }
    image.caption = fmt::format("depth, {:.2f} m (violet) to {:.2f} m (yellow)", near, far);
    return image;
}

CaptionedImage stateImage(const DepthFilter& filter) {
    CaptionedImage image = emptyImage(filter.reference());
    std::array<int, 3> counts{};
    const auto columns = static_cast<unsigned>(image.picture.columns);
    for (unsigned i = 0; i < image.picture.pixels.size(); ++i) {
        const auto state = static_cast<std::size_t>(filter.state(i / columns, i % columns));
        image.picture.pixels[i] = kStateColors[state];
        ++counts[state];
    }
    const auto percent = [&](DepthState state) {
        return 100. * counts[static_cast<std::size_t>(state)] / double(image.picture.pixels.size());
    };
    image.caption = fmt::format("converged {:.0f} % (green), given up {:.0f} % (dark red)",
                                percent(DepthState::converged), percent(DepthState::givenUp));
    return image;
}

CaptionedImage errorImage(const ImageF& depth, const ImageF& recorded) {
    CaptionedImage image = emptyImage(depth);
    std::vector<float> errors;
    for (unsigned i = 0; i < depth.getSize(); ++i) {
        const float truth = recorded.bitmap[i];
        if (!(truth > 0.F && depth.bitmap[i] > 0.F)) continue;
        errors.push_back(std::abs(depth.bitmap[i] - truth) / truth);
        image.picture.pixels[i] = viridis(errors.back() / kFullError);
    }
    if (errors.empty()) {
        image.caption = "no depth to compare";
        return image;
    }
    image.caption = fmt::format("relative error, median {:.1f} % (yellow: 10 %)",
                                100. * median(std::move(errors), 0.));
    return image;
}

}  // namespace

std::vector<CaptionedImage> convergenceImages(const DepthFilter& filter, const ImageF& recorded,
                                              const std::string& caption) {
    const ImageF depth = filter.view().depth;
    std::vector<CaptionedImage> images{
        {caption, greyPicture(filter.reference())}, depthImage(depth), stateImage(filter)};
    const bool isRecorded = std::any_of(recorded.bitmap, recorded.bitmap + recorded.getSize(),
                                        [](float z) { return z > 0.F; });
    if (isRecorded) images.push_back(errorImage(depth, recorded));
    return images;
}

void ConvergenceFigure::add(const DepthFilter& filter, const ImageF& recorded, double timestamp) {
    if (references_++ % stride_ != 0) return;
    rows_.push_back(convergenceImages(
        filter, recorded, fmt::format("reference {}, at {:.3f} s", references_, timestamp)));
    if (rows_.size() <= kMaxRows) return;
    for (std::size_t k = 1; 2 * k < rows_.size(); ++k) rows_[k] = std::move(rows_[2 * k]);
    rows_.resize((rows_.size() + 1) / 2);
    stride_ *= 2;
}

}  // namespace photonav
