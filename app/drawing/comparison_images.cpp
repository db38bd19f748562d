// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/comparison_images.hpp"

#include <fmt/format.h>

#include "mapping/view_difference.hpp"

namespace photonav {
namespace {

constexpr double kFullDifference = 0.5;  // grey values; brightest colour of the difference

}  // namespace

std::vector<CaptionedImage> comparisonImages(const View& observed, const View& predicted,
                                             const std::string& caption) {
    const ViewDifference difference = compareViews(observed, predicted);
    return {{caption, greyPicture(observed.intensity)},
            {fmt::format("predicted ({:.0f} % of the pixels)", 100. * difference.predicted),
             predictedPicture(predicted)},
            {difference.meanIntensity ? fmt::format("difference (mean {:.3f}; yellow: ≥ {})",
                                                    *difference.meanIntensity, kFullDifference)
                                      : "no pixel is predicted",
             differencePicture(observed.intensity, predicted, kFullDifference)}};
}

}  // namespace photonav
