// SPDX-License-Identifier: BSD-3-Clause
#include "figures/images.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace photonav {
namespace {

/// @param colorAt colour of the i-th pixel
template <typename ColorAt>
Picture pictureOf(const ImageF& shape, const ColorAt& colorAt) {
    Picture picture{{}, static_cast<int>(shape.getWidth())};
    picture.pixels.reserve(shape.getSize());
    for (unsigned i = 0; i < shape.getSize(); ++i) picture.pixels.push_back(colorAt(i));
    return picture;
}

}  // namespace

Picture greyPicture(const ImageF& image, double scale) {
    return pictureOf(image, [&](unsigned i) { return greyColor(scale * image.bitmap[i]); });
}

Picture predictedPicture(const View& predicted) {
    return pictureOf(predicted.intensity, [&](unsigned i) {
        return predicted.depth.bitmap[i] > 0.F ? greyColor(predicted.intensity.bitmap[i])
                                               : kUnknownColor;
    });
}

Picture differencePicture(const ImageF& observed, const View& predicted, double full) {
    return pictureOf(observed, [&](unsigned i) {
        if (!(predicted.depth.bitmap[i] > 0.F)) return kUnknownColor;
        return viridis(std::abs(predicted.intensity.bitmap[i] - observed.bitmap[i]) / full);
    });
}

Picture contributionPicture(const ImageF& intensity, const ImageF& contribution) {
    if (intensity.getSize() == 0 || intensity.getWidth() != contribution.getWidth() ||
        intensity.getHeight() != contribution.getHeight())
        throw std::invalid_argument("contributionPicture: empty images, or of different size");
    std::vector<float> ranked(contribution.bitmap, contribution.bitmap + contribution.getSize());
    const auto nth = ranked.begin() + static_cast<long>(0.995 * double(ranked.size() - 1));
    std::nth_element(ranked.begin(), nth, ranked.end());
    const double top = std::sqrt(std::max(*nth, 1e-24F));
    return pictureOf(intensity, [&](unsigned i) {
        const double weight = std::min(std::sqrt(std::max(contribution.bitmap[i], 0.F)) / top, 1.);
        const double opacity = std::min(1., 2. * weight);
        const Color color = inferno(weight), ground = greyColor(0.45 * intensity.bitmap[i]);
        const auto mixed = [&](std::uint8_t above, std::uint8_t below) {
            return static_cast<std::uint8_t>(std::lround(opacity * above + (1. - opacity) * below));
        };
        return Color{mixed(color.red, ground.red), mixed(color.green, ground.green),
                     mixed(color.blue, ground.blue)};
    });
}

Figure imagesFigure(const std::vector<std::vector<CaptionedImage>>& rows, double width) {
    Figure figure;
    for (const auto& row : rows) {
        auto& plots = figure.rows.emplace_back();
        for (const CaptionedImage& image : row)
            plots.emplace_back(Plot::image(image.picture, width)).title = image.caption;
    }
    return figure;
}

}  // namespace photonav
