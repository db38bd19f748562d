// SPDX-License-Identifier: BSD-3-Clause
#include "replay/depth_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "evaluation/averages.hpp"
#include "io/error.hpp"

namespace photonav {
namespace {

constexpr std::size_t kLooks = 5;
constexpr unsigned kPixelStep = 7;  // of the median
constexpr unsigned kRowStep = 4;    // of the noise
constexpr float kMaxStep = 0.03F;   // of depth from pixel to pixel, on one surface; relative

/// Of bends, those that are kept: the largest are where surfaces meet.
constexpr double kShareKept = 0.9;
constexpr double kMeanKept = 0.6573;  // of |x| up to its 90 % quantile, x standard normal

/// Cameras that are sold as depth cameras have 0.5 mm and more at 1 m; what is below is rendered,
/// or measured by instruments that may be taken for exact.
constexpr double kLeastSensorNoise = 2e-4;  // [m]
constexpr double kUnregisteredError = 0.1;  // as in config/cameras/kinect_unregistered.yaml

/// Standard deviation of the noise of single values, from the absolute second differences x[i - 1]
/// - 2 x[i] + x[i + 1].
double sigmaOf(std::vector<float> bends) {
    const auto kept = static_cast<std::ptrdiff_t>(kShareKept * static_cast<double>(bends.size()));
    if (kept == 0) return 0.;
    std::nth_element(bends.begin(), bends.begin() + kept, bends.end());
    const double mean = std::accumulate(bends.begin(), bends.begin() + kept, 0.) / double(kept);
    return mean / (std::sqrt(6.) * kMeanKept);
}

}  // namespace

void DepthNoise::add(const ImageF& depth) {
    for (unsigned v = 0; v < depth.getHeight(); v += kRowStep) {
        const float* z = depth[v];
        for (unsigned u = 1; u + 1 < depth.getWidth(); ++u) {
            const float most = kMaxStep * z[u];
            if (!(z[u - 1] > 0.F && z[u] > 0.F && z[u + 1] > 0.F)) continue;
            if (std::abs(z[u - 1] - z[u]) > most || std::abs(z[u + 1] - z[u]) > most) continue;
            const float bend = std::abs(1.F / z[u - 1] - 2.F / z[u] + 1.F / z[u + 1]);
            relative_.push_back(bend);
            absolute_.push_back(bend * z[u] * z[u]);
        }
    }
}

double DepthNoise::atOneMetre() const { return sigmaOf(relative_); }

double DepthNoise::overall() const { return sigmaOf(absolute_); }

DepthLook lookAtDepth(const Recording& recording) {
    DepthLook look;
    std::vector<float> depths;
    bool anyRead = false;
    const std::size_t count = recording.sequence.frames.size();
    for (std::size_t i = 0; i < count; i += std::max<std::size_t>(1, count / kLooks)) {
        View view;
        try {
            view = recording.view(i);
        } catch (const InputError&) {
            continue;
        }
        anyRead = true;
        look.noise.add(view.depth);
        for (unsigned k = 0; k < view.depth.getSize(); k += kPixelStep) {
            if (view.depth.bitmap[k] > 0.F) depths.push_back(view.depth.bitmap[k]);
        }
    }
    if (anyRead) look.median = median(std::move(depths), 0.);
    return look;
}

DepthError depthErrorOf(const Recording& recording, const DepthNoise& noise) {
    const Sequence& sequence = recording.sequence;
    if (sequence.depthError) return {*sequence.depthError, false};
    const double step = 1. / sequence.depthScale;  // to which depth is rounded
    const bool isRecorded = recording.stereo.empty() && sequence.hasDepth();
    const bool isOfSensor =
        isRecorded && noise.atOneMetre() > kLeastSensorNoise && noise.overall() > step;
    return {isOfSensor ? kUnregisteredError : 0., true};
}

}  // namespace photonav
