// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/measured_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "alignment/hole_margin.hpp"
#include "geometry/constants.hpp"

namespace photonav {
namespace {

constexpr double kWithin = 3.;  // standard deviations

/// Least and largest depth within the margin of each pixel; pixels without a surface do not count.
struct DepthRange {
    ImageF least, most;
};

/// Replaces pixels by the best one within `reach` pixels along one axis.
/// @param step from a pixel to the next one along the axis
template <class Better>
void spread(ImageF& image, int reach, int count, int step, int lines, int toNextLine,
            const Better& better) {
    std::vector<float> line(static_cast<std::size_t>(count));
    for (int l = 0; l < lines; ++l) {
        float* first = image.bitmap + static_cast<std::ptrdiff_t>(l) * toNextLine;
        for (int i = 0; i < count; ++i) line[i] = first[i * step];
        for (int i = 0; i < count; ++i) {
            float best = line[i];
            const int end = std::min(count - 1, i + reach);
            for (int k = std::max(0, i - reach); k <= end; ++k) best = better(best, line[k]);
            first[i * step] = best;
        }
    }
}

template <class Better>
ImageF spread(ImageF image, const HoleMargin& margin, const Better& better) {
    const int width = static_cast<int>(image.getWidth());
    const int height = static_cast<int>(image.getHeight());
    spread(image, margin.columns, width, 1, height, width, better);
    spread(image, margin.rows, height, width, width, 1, better);
    return image;
}

DepthRange rangeOf(const ImageF& depth, const HoleMargin& margin) {
    ImageF least = depth;
    for (unsigned i = 0; i < least.getSize(); ++i) {
        if (!(least.bitmap[i] > 0.F)) least.bitmap[i] = static_cast<float>(kInfinity);
    }
    return {spread(std::move(least), margin, [](float a, float b) { return std::min(a, b); }),
            spread(depth, margin, [](float a, float b) { return std::max(a, b); })};
}

}  // namespace

MeasuredSurfaces::MeasuredSurfaces(std::shared_ptr<const ViewSource> map,
                                   const DepthAccuracy& accuracy)
    : map_(std::move(map)), accuracy_(accuracy) {}

void MeasuredSurfaces::measure(const View& expected, const ImageF& measured, const Camera& camera,
                               const UncertainPose& T_c_w) {
    contradicted_.clear();
    width_ = camera.width;
    if (measured.getSize() == 0) return;
    if (measured.getSize() != expected.depth.getSize()) {
        throw std::invalid_argument("measured surfaces: depth image and view differ in size");
    }
    const HoleMargin margin = holeMargin(T_c_w.covariance, camera, meanDepth(expected));
    const DepthRange range = rangeOf(expected.depth, margin);
    const double alongAxis = T_c_w.covariance(2, 2);
    for (unsigned v = 0; v < measured.getHeight(); ++v) {
        for (unsigned u = 0; u < measured.getWidth(); ++u) {
            const double z = measured[v][u];
            if (!(z > 0.) || !(expected.depth[v][u] > 0.F)) continue;
            const double sigma = accuracy_.sigmaAtOneMetre * z * z;
            const double error = kWithin * std::sqrt(sigma * sigma + alongAxis) + accuracy_.ofMap;
            if (z < range.least[v][u] - error || z > range.most[v][u] + error) {
                contradicted_.push_back({u, v});
            }
        }
    }
}

void MeasuredSurfaces::render(const Camera& camera, const Pose& T_c_w, View& view) const {
    map_->render(camera, T_c_w, view);
    if (contradicted_.empty()) return;
    const unsigned scale = std::max(1U, (width_ + camera.width / 2) / camera.width);
    for (const Pixel& pixel : contradicted_) {
        view.depth[std::min(pixel.v / scale, camera.height - 1)]
                  [std::min(pixel.u / scale, camera.width - 1)] = 0.F;
    }
}

}  // namespace photonav
