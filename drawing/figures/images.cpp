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

/// A picture with axes and a colour bar, each pixel drawn as a square of a whole number of pixels.
/// @param colorAt colour of a share in [0, 1] of the scale
Figure pixelsFigure(const std::string& title, Picture picture, const Axis& scale,
                    Color (*colorAt)(double)) {
    constexpr int kWidest = 800;  // at least half of it is filled
    if (picture.pixels.empty()) throw std::invalid_argument("pixelsFigure: the picture is empty");
    const int columns = picture.columns;
    Plot plot = Plot::image(std::move(picture), columns * std::max(1, kWidest / columns));
    plot.hasAxes = true;
    plot.colorBar(scale, colorAt);
    return {.title = title, .rows = {{plot}}};
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

Picture differencePicture(const ImageF& observed, const View& predicted) {
    return pictureOf(observed, [&](unsigned i) {
        if (!(predicted.depth.bitmap[i] > 0.F)) return kUnknownColor;
        return viridis(std::abs(predicted.intensity.bitmap[i] - observed.bitmap[i]) /
                       kFullDifference);
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

Figure greyFigure(const std::string& title, const ImageF& image) {
    return pixelsFigure(title, greyPicture(image), {.min = 0., .max = 1., .label = "grey value"},
                        greyColor);
}

Figure contributionFigure(const std::string& title, const ImageF& intensity,
                          const ImageF& contribution) {
    return pixelsFigure(title, contributionPicture(intensity, contribution),
                        {.min = 0., .max = 1., .label = "root of the share of the largest"},
                        inferno);
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
