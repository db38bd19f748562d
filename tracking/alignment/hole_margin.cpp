// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/hole_margin.hpp"

#include <algorithm>
#include <cmath>

namespace photonav {
namespace {

constexpr double kUncertain = 3.;     // standard deviations
constexpr double kConverging = 0.03;  // where an alignment converges from [image widths]

/// Along a row or column of `count` pixels, `step` from one to the next.
void widen(float* depth, int count, std::ptrdiff_t step, int margin) {
    const auto pass = [=](float* first, std::ptrdiff_t forward) {
        int sinceHole = margin;  // or more
        for (int i = 0; i < count; ++i, first += forward) {
            sinceHole = *first > 0.F ? sinceHole + 1 : 0;
            if (sinceHole <= margin) *first = 0.F;
        }
    };
    pass(depth, step);
    pass(depth + (count - 1) * step, -step);
}

/// Standard deviation of the motion of the content at the image's side [pixels].
/// @param alongAxis motion by a step along and a turn across an axis of the image, at its centre
double motion(const Matrix6& covariance, const Vector6& alongAxis, double side, double depth) {
    const double atSide = covariance(2, 2) / (depth * depth) + covariance(5, 5);
    return std::sqrt(std::max(0., alongAxis.dot(covariance * alongAxis) + side * side * atSide));
}

int pixels(double sigma, const Camera& camera) {
    return static_cast<int>(std::min(kUncertain * sigma, kConverging * camera.width));
}

}  // namespace

double meanDepth(const View& view) {
    double sum = 0.;
    double count = 0.;
    for (unsigned i = 0; i < view.depth.getSize(); ++i) {
        if (view.depth.bitmap[i] <= 0.F) continue;
        sum += 1. / view.depth.bitmap[i];
        ++count;
    }
    return count > 0. ? count / sum : 1.;
}

HoleMargin holeMargin(const Matrix6& covariance, const Camera& camera, double depth) {
    Vector6 u = Vector6::Zero();
    u[0] = camera.fx() / depth;
    u[4] = camera.fx();
    Vector6 v = Vector6::Zero();
    v[1] = camera.fy() / depth;
    v[3] = -camera.fy();
    const double side = 0.5 * camera.width;
    return {pixels(motion(covariance, u, side, depth), camera),
            pixels(motion(covariance, v, side, depth), camera)};
}

void widenHoles(View& view, const HoleMargin& margin) {
    if (margin.columns == 0 && margin.rows == 0) return;
    const int width = static_cast<int>(view.depth.getWidth());
    const int height = static_cast<int>(view.depth.getHeight());
    for (int v = 0; v < height; ++v) widen(view.depth[v], width, 1, margin.columns);
    for (int u = 0; u < width; ++u) widen(view.depth.bitmap + u, height, width, margin.rows);
}

}  // namespace photonav
