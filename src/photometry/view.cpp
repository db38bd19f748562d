// SPDX-License-Identifier: BSD-3-Clause
#include "photometry/view.hpp"

#include <array>
#include <numeric>
#include <stdexcept>

namespace photonav {
namespace {

/// One image row after the horizontal pass: 4 times the filtered intensity, and the least depth of
/// each pixel and its two neighbours.
struct FilteredRow {
    std::vector<float> intensity, depth;

    explicit FilteredRow(unsigned width) : intensity(width), depth(width) {}

    void filter(const float* I, const float* z, unsigned width) {
        const unsigned last = width - 1;
        for (unsigned u = 1; u < last; ++u) {
            intensity[u] = (I[u - 1] + I[u + 1]) + 2.F * I[u];
            depth[u] = std::min(std::min(z[u - 1], z[u + 1]), z[u]);
        }
        // Linear extrapolation beyond the border, which leaves the border pixel as it is.
        intensity[0] = 4.F * I[0];
        depth[0] = std::min(z[0], z[std::min(1U, last)]);
        intensity[last] = 4.F * I[last];
        depth[last] = std::min(z[last], z[last - std::min(1U, last)]);
    }
};

}  // namespace

bool isBlack(const ImageF& image) {
    const double sum = std::accumulate(image.bitmap, image.bitmap + image.getSize(), 0.);
    return sum < 0.02 * image.getSize();
}

void applyPointSpread(View& view) {
    const unsigned width = view.intensity.getWidth();
    const unsigned height = view.intensity.getHeight();
    if (view.depth.getWidth() != width || view.depth.getHeight() != height) {
        throw std::invalid_argument("applyPointSpread: intensity and depth differ in size");
    }
    if (width == 0 || height == 0) return;

    std::array<FilteredRow, 3> rows{FilteredRow(width), FilteredRow(width), FilteredRow(width)};
    const auto filtered = [&](unsigned v) -> FilteredRow& { return rows[v % 3]; };
    filtered(0).filter(view.intensity[0], view.depth[0], width);
    for (unsigned v = 0; v < height; ++v) {
        const bool border = v == 0 || v + 1 == height;
        if (v + 1 < height) {
            filtered(v + 1).filter(view.intensity[v + 1], view.depth[v + 1], width);
        }
        const FilteredRow& here = filtered(v);
        const FilteredRow& above = filtered(v == 0 ? std::min(1U, height - 1) : v - 1);
        const FilteredRow& below = filtered(v + 1 < height ? v + 1 : (v == 0 ? 0 : v - 1));
        const float sides = border ? 0.F : 1.F;  // linear continuation, as for the columns
        const float centre = border ? 4.F : 2.F;
        float* I = view.intensity[v];
        for (unsigned u = 0; u < width; ++u) {
            const float sum =
                sides * (above.intensity[u] + below.intensity[u]) + centre * here.intensity[u];
            const float z = std::min(std::min(above.depth[u], below.depth[u]), here.depth[u]);
            I[u] = z > 0.F ? 0.0625F * sum : I[u];
        }
    }
}

}  // namespace photonav
