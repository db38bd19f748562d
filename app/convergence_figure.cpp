// SPDX-License-Identifier: BSD-3-Clause
#include "convergence_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "averages.hpp"

namespace photonav {
namespace {

constexpr double kFullError = 0.1;  // brightest colour of the relative error
constexpr std::array<Color, 3> kStateColors{{{205, 205, 205}, {38, 140, 122}, {222, 79, 12}}};

Color onScale(double share) {
    static const auto scale = viridis();
    return scale[static_cast<std::size_t>(255. * std::clamp(share, 0., 1.))];
}

Panel emptyPanel(const ImageF& like) {
    return {
        {}, std::vector<Color>(like.getSize(), kNothingKnown), static_cast<int>(like.getWidth())};
}

/// Colours from the depth that a twentieth of the pixels is nearer than to the one that as many are
/// farther than.
Panel depthPanel(const ImageF& depth) {
    Panel panel = emptyPanel(depth);
    std::vector<float> known;
    std::copy_if(depth.bitmap, depth.bitmap + depth.getSize(), std::back_inserter(known),
                 [](float z) { return z > 0.F; });
    if (known.empty()) {
        panel.caption = "no depth found";
        return panel;
    }
    std::sort(known.begin(), known.end());
    const double near = known[known.size() / 20];
    const double far = known[known.size() - 1 - known.size() / 20];
    for (unsigned i = 0; i < depth.getSize(); ++i) {
        const double z = depth.bitmap[i];
        if (z > 0.) panel.pixels[i] = onScale((z - near) / std::max(far - near, 1e-6));
    }
    panel.caption = fmt::format("depth found, {:.2f} m (violet) to {:.2f} m (yellow)", near, far);
    return panel;
}

Panel statePanel(const DepthFilter& filter) {
    Panel panel = emptyPanel(filter.reference());
    std::array<int, 3> counts{};
    const auto columns = static_cast<unsigned>(panel.columns);
    for (unsigned i = 0; i < panel.pixels.size(); ++i) {
        const auto state = static_cast<std::size_t>(filter.state(i / columns, i % columns));
        panel.pixels[i] = kStateColors[state];
        ++counts[state];
    }
    const auto percent = [&](DepthState state) {
        return 100. * counts[static_cast<std::size_t>(state)] / double(panel.pixels.size());
    };
    panel.caption = fmt::format("green: known {:.0f} %, orange: given up {:.0f} %",
                                percent(DepthState::converged), percent(DepthState::givenUp));
    return panel;
}

Panel errorPanel(const ImageF& depth, const ImageF& recorded) {
    Panel panel = emptyPanel(depth);
    std::vector<float> errors;
    for (unsigned i = 0; i < depth.getSize(); ++i) {
        const float truth = recorded.bitmap[i];
        if (!(truth > 0.F && depth.bitmap[i] > 0.F)) continue;
        errors.push_back(std::abs(depth.bitmap[i] - truth) / truth);
        panel.pixels[i] = onScale(errors.back() / kFullError);
    }
    if (errors.empty()) {
        panel.caption = "no error: no depth found";
        return panel;
    }
    panel.caption = fmt::format("its error (median {:.1f} %, yellow: 10 %)",
                                100. * median(std::move(errors), 0.));
    return panel;
}

}  // namespace

std::vector<Panel> convergencePanels(const DepthFilter& filter, const ImageF& recorded,
                                     const std::string& caption) {
    const ImageF depth = filter.view().depth;
    std::vector<Panel> panels{imagePanel(filter.reference(), caption), depthPanel(depth),
                              statePanel(filter)};
    const bool isRecorded = std::any_of(recorded.bitmap, recorded.bitmap + recorded.getSize(),
                                        [](float z) { return z > 0.F; });
    if (isRecorded) panels.push_back(errorPanel(depth, recorded));
    return panels;
}

}  // namespace photonav
