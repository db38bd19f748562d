// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/pattern_projector.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "photometry/opencv_image.hpp"

namespace photonav {
namespace {

constexpr unsigned kPatternSeed = 4;
constexpr double kShareOfDots = 0.25;  // of the pixels
constexpr double kDotWidth = 0.6;      // standard deviation [pixels]
constexpr float kShadow = 0.03F;       // of depth: what is as much nearer casts a shadow

}  // namespace

PatternProjector::PatternProjector(const Camera& camera, double contrast)
    : focalLength_(camera.fx()), contrast_(contrast), pattern_(camera.height, camera.width) {
    std::mt19937 random(kPatternSeed);
    std::bernoulli_distribution isDot(kShareOfDots);
    for (unsigned i = 0; i < pattern_.getSize(); ++i)
        pattern_.bitmap[i] = isDot(random) ? 1.F : 0.F;
    cv::Mat pixels = asMat(pattern_);
    cv::GaussianBlur(pixels, pixels, {}, kDotWidth);
}

void PatternProjector::illuminate(View& view, const ImageF& projected, double baseline) const {
    const unsigned last = pattern_.getWidth() - 1;
    for (unsigned v = 0; v < view.depth.getHeight(); ++v) {
        for (unsigned u = 0; u <= last; ++u) {
            const double z = view.depth[v][u];
            if (!(z > 0.)) continue;
            const double column = u + focalLength_ * baseline / z;  // in the left camera's view
            if (column > last) continue;
            const auto left = static_cast<unsigned>(column);
            const unsigned right = std::min(left + 1, last);
            const float nearest = std::max(projected[v][left], projected[v][right]);
            if (nearest < (1.F - kShadow) * view.depth[v][u]) continue;
            const auto part = static_cast<float>(column - left);
            const float dot = (1.F - part) * pattern_[v][left] + part * pattern_[v][right];
            view.intensity[v][u] *= 1.F + static_cast<float>(contrast_ / (z * z)) * dot;
        }
    }
}

}  // namespace photonav
