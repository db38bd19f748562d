// SPDX-License-Identifier: BSD-3-Clause
#include "figures/comparison_images.hpp"

#include <fmt/format.h>

#include "geometry/constants.hpp"
#include "recording/halved_view.hpp"

namespace photonav {
std::vector<CaptionedImage> comparisonImages(const View& observed, const View& predicted,
                                             const std::string& caption) {
    const ViewDifference difference = compareViews(observed, predicted);
    View seen = observed, shown = predicted;
    const int halvings = halvingsToShow(observed.intensity.getWidth());
    halve(seen, halvings);
    halve(shown, halvings);
    return {{caption, greyPicture(seen.intensity)},
            {fmt::format("predicted ({:.0f} % of the pixels)", 100. * difference.predicted),
             predictedPicture(shown)},
            {difference.meanIntensity ? fmt::format("difference (mean {:.3f}; yellow: ≥ {})",
                                                    *difference.meanIntensity, kFullDifference)
                                      : "no pixel is predicted",
             differencePicture(seen.intensity, shown)}};
}

Figure recordedFramesFigure(const RecordedComparison& comparison) {
    std::vector<std::vector<CaptionedImage>> rows;
    for (const NearestFrame& frame : comparison) {
        rows.push_back({{fmt::format("predicted on the path at {:.2f} m", frame.length),
                         predictedPicture(frame.fromPath)}});
        const auto images =
            comparisonImages(frame.observed, frame.predicted,
                             fmt::format("recorded {:.0f} cm and {:.0f} degrees away",
                                         100. * frame.distance, frame.angle / kDegree));
        rows.back().insert(rows.back().end(), images.begin(), images.end());
    }
    return imagesFigure(rows, 400.);
}

}  // namespace photonav
