// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/hole_margin.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace photonav {
namespace {

constexpr double kUncertain = 3.;     // standard deviations
constexpr double kConverging = 0.03;  // where an alignment converges from [image widths]

using Mask = std::vector<unsigned char>;

/// Marks the holes of a row. @return whether there are any
bool markHoles(const float* depth, std::size_t count, unsigned char* holes) {
    unsigned char any = 0;
    for (std::size_t i = 0; i < count; ++i) {
        holes[i] = depth[i] > 0.F ? 0 : 1;
        any |= holes[i];
    }
    return any != 0;
}

void mark(const unsigned char* other, std::size_t count, unsigned char* marked) {
    for (std::size_t i = 0; i < count; ++i) marked[i] |= other[i];
}

void eraseMarked(const Mask& marked, float* depth) {
    for (std::size_t i = 0; i < marked.size(); ++i) depth[i] = marked[i] != 0 ? 0.F : depth[i];
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
    const unsigned height = view.depth.getHeight();
    const std::size_t width = view.depth.getWidth();
    const std::size_t columns = std::size_t(margin.columns), rows = std::size_t(margin.rows);
    Mask holes(width + 2 * columns, 0);  // of one row; none beyond the image
    Mask alongRows((height + 2 * rows) * width, 0);
    bool any = false;
    for (unsigned v = 0; v < height; ++v) {
        if (!markHoles(view.depth[v], width, &holes[columns])) continue;
        any = true;
        for (std::size_t shift = 0; shift <= 2 * columns; ++shift) {
            mark(&holes[shift], width, &alongRows[(v + rows) * width]);
        }
    }
    if (!any) return;
    Mask marked(width * height, 0);
    for (std::size_t shift = 0; shift <= 2 * rows; ++shift) {
        mark(&alongRows[shift * width], marked.size(), marked.data());
    }
    eraseMarked(marked, view.depth.bitmap);
}

}  // namespace photonav
