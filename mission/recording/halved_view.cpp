// SPDX-License-Identifier: BSD-3-Clause
#include "recording/halved_view.hpp"

#include "alignment/image_pyramid.hpp"

namespace photonav {
namespace {

View halvedView(const View& view) {
    View half;
    half.intensity = halvedAsRendered(view.intensity);
    half.depth.resize(half.intensity.getHeight(), half.intensity.getWidth());
    for (unsigned v = 0; v < half.depth.getHeight(); ++v) {
        for (unsigned u = 0; u < half.depth.getWidth(); ++u) {
            half.depth[v][u] = view.depth[2 * v][2 * u];
        }
    }
    return half;
}

}  // namespace

void halve(View& view, int times) {
    for (int i = 0; i < times; ++i) view = halvedView(view);
}

int halvingsToShow(unsigned width) {
    int halvings = 0;
    for (; width > kShownWidth; width /= 2) ++halvings;
    return halvings;
}

}  // namespace photonav
