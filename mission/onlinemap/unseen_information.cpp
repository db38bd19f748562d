// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/unseen_information.hpp"

#include <algorithm>
#include <utility>

namespace photonav {
namespace {

constexpr double kLeastKnown = 0.5;  // share of a band that stands for its surroundings
constexpr int kRemembered = 20;      // views: farther back, the scene may have been another
/// The average of the flight counts as if this share of a band had been seen: the surroundings of a
/// view are more alike to it, but a few pixels of it may show anything.
constexpr double kFromFlight = 0.25;

/// The bands of a view. Most views are known as a whole: only what is partly known is copied.
class Bands {
  public:
    explicit Bands(const View& view) : view_(view) {}

    double pixels(unsigned band) const { return static_cast<double>(endOf(band) - beginOf(band)); }

    /// Number of pixels of the band that show a surface.
    double known(unsigned band) const {
        const float* depth = view_.depth.bitmap;
        return static_cast<double>(std::count_if(depth + beginOf(band), depth + endOf(band),
                                                 [](float z) { return z > 0.F; }));
    }

    Matrix6 information(unsigned band, const InformationModel& model) {
        if (part_.depth.getSize() == 0) {
            part_.intensity = view_.intensity;
            part_.depth.resize(view_.depth.getHeight(), view_.depth.getWidth(), 0.F);
        }
        const float* depth = view_.depth.bitmap;
        float* part = part_.depth.bitmap;
        std::copy(depth + beginOf(band), depth + endOf(band), part + beginOf(band));
        const Matrix6 information = model(part_);
        std::fill(part + beginOf(band), part + endOf(band), 0.F);
        return information;
    }

  private:
    std::size_t beginOf(unsigned band) const {
        const std::size_t rows = view_.depth.getHeight();
        return band * rows / UnseenInformation::kBands * view_.depth.getWidth();
    }
    std::size_t endOf(unsigned band) const { return beginOf(band + 1); }

    const View& view_;
    View part_;  // of which one band at a time has depth
};

}  // namespace

void UnseenInformation::observe(const View& shown, const InformationModel& model) {
    Bands bands(shown);
    for (unsigned band = 0; band < kBands; ++band) {
        const double known = bands.known(band);
        if (!(known > 0.) || known < kLeastKnown * bands.pixels(band)) continue;
        Average& average = (*averages_)[band];
        average.views = std::min(average.views + 1, kRemembered);
        average.perPixel +=
            (bands.information(band, model) / known - average.perPixel) / average.views;
    }
}

InformationModel UnseenInformation::complete(InformationModel model) const {
    return [model = std::move(model), averages = averages_](const View& view) -> Matrix6 {
        Matrix6 information = model(view);
        Bands bands(view);
        for (unsigned band = 0; band < kBands; ++band) {
            const double known = bands.known(band), pixels = bands.pixels(band);
            if (known == pixels) continue;
            Matrix6 seen = Matrix6::Zero();
            if (known > 0.) seen = bands.information(band, model);
            const double ofFlight = kFromFlight * pixels;
            information += (pixels - known) / (known + ofFlight) *
                           (seen + ofFlight * (*averages)[band].perPixel);
        }
        return information;
    };
}

}  // namespace photonav
