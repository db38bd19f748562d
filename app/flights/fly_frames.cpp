// SPDX-License-Identifier: BSD-3-Clause
#include "flights/fly_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figures/comparison_images.hpp"
#include "flights/fly_report.hpp"
#include "recording/halved_view.hpp"
#include "recording/view_difference.hpp"

namespace photonav {
namespace {

constexpr double kFrameWidth = 400.;  // of an image [px]

const char* nameOf(ImageUse use) {
    switch (use) {
        case ImageUse::used:
            return "image used";
        case ImageUse::rejected:
            return "image rejected";
        case ImageUse::missing:
            break;
    }
    return "image never arrived";
}

View predictedView(const FlightSample& sample, const FlightWorld& world) {
    View view;
    world.map->render(world.camera, sample.belief.mean, view);
    halve(view, halvingsToShow(world.camera.width));
    expose(view.intensity, sample.exposure);
    return view;
}

std::string captionOf(const FlightSample& sample, const PathPoint& believed) {
    const Eigen::Vector3d truth = sample.T_c_w.inverse().translation();
    return fmt::format("{:.1f} s: {}; position error {}, predicted standard deviation {}",
                       sample.time, nameOf(sample.image),
                       lengthText((truth - believed.position).norm()),
                       lengthText(std::sqrt(believed.positionCovariance.trace())));
}

}  // namespace

std::vector<ReportFrame> flightFrames(const std::string& planner, const FlightResult& flight,
                                      const std::vector<KeptExposure>& exposures,
                                      const FlightWorld& world) {
    std::vector<ReportFrame> frames;
    for (const KeptExposure& exposure : exposures) {
        const auto sample =
            std::find_if(flight.samples.begin(), flight.samples.end(),
                         [&](const FlightSample& s) { return s.time == exposure.time; });
        if (sample == flight.samples.end()) continue;
        const PathPoint believed = makePathPoint(sample->belief, 0., 0., 0.);
        const std::vector<CaptionedImage> images =
            comparisonImages(exposure.view, predictedView(*sample, world), "observed");
        frames.push_back({captionOf(*sample, believed), imagesFigure({images}, kFrameWidth).png(),
                          fmt::format("{}, flight {}", planner, flight.number), believed,
                          sample->T_c_w.inverse().translation(), plannerColor(planner)});
    }
    return frames;
}

}  // namespace photonav
