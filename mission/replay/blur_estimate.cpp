// SPDX-License-Identifier: BSD-3-Clause
#include "replay/blur_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "alignment/image_pyramid.hpp"
#include "estimation/calibration.hpp"
#include "evaluation/averages.hpp"

namespace photonav {

bool BlurEstimate::contradicts(double assumedBlur) const {
    return std::abs(variance - assumedBlur * assumedBlur) > 2. * sigma;
}

std::optional<BlurEstimate> estimateBlur(const ReplayRun& run) {
    constexpr std::size_t kLeastImages = 5;
    std::vector<double> variances;  // [pixels^2 of the tracked images]
    for (const ReplayedFrame& frame : run.frames) {
        const Alignment& a = frame.tracked.alignment;
        if (frame.status != FrameStatus::tracked || a.verdict != Verdict::converged) continue;
        if (a.blurSigma < kBlurError) variances.push_back(run.blur * run.blur + a.blur);
    }
    if (variances.size() < kLeastImages) return {};
    BlurEstimate estimate;
    estimate.variance = median(variances, 0.);
    std::vector<double> away;
    away.reserve(variances.size());
    for (const double v : variances) away.push_back(std::abs(v - estimate.variance));
    const double scatter = 1.4826 * median(away, 0.);
    estimate.sigma = std::hypot(scatter / std::sqrt(double(variances.size())), kBlurError);
    for (int i = 0; i < run.halvings; ++i) {
        estimate.variance = blurVarianceBeforeHalving(estimate.variance);
        estimate.sigma *= 4.;
    }
    estimate.blur = std::sqrt(std::max(0., estimate.variance));
    return estimate;
}

}  // namespace photonav
