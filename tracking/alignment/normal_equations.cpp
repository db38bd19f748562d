// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/normal_equations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "alignment/gradient_noise.hpp"
#include "alignment/product_sums.hpp"
#include "photometry/simd.hpp"

namespace photonav {

namespace {

constexpr double kMaxNoise = 0.25;  // variance of a noise gradient [variance of the image noise]

using simd::Float;
using simd::Int;
using simd::kWidth;

Float at(const std::vector<float>& image, std::size_t index) {
    return simd::load<Float>(image.data() + index);
}

/// Everything about the pixels of one image row; lane 0 of vector 0 is column 1.
struct RowInput {
    const std::vector<float>& intensity;
    const std::vector<float>& inverseDepth;
    const std::vector<float>& observed;
    std::size_t pitch;
};

/// The pixels that count, by the rules of photometricInformation(): inverse depth is linear along
/// any line on a plane, however oblique, so its second difference shows edges; a saturated pixel
/// does not respond to motion.
Int counts(const RowInput& in, std::size_t index, float jump, float saturation) {
    const Float w = at(in.inverseDepth, index);
    const Float horizontal =
        simd::abs(at(in.inverseDepth, index - 1) + at(in.inverseDepth, index + 1) - 2.F * w);
    const Float vertical = simd::abs(at(in.inverseDepth, index - in.pitch) +
                                     at(in.inverseDepth, index + in.pitch) - 2.F * w);
    const Float I = at(in.intensity, index);
    return (simd::max(horizontal, vertical) <= jump * w) & (I > saturation) &
           (I < 1.F - saturation);
}

}  // namespace

double robustSigmaOf(const std::vector<float>& residuals) {
    constexpr int kBins = 4096;  // of |r| in [0, 2)
    std::vector<unsigned> histogram(kBins, 0);
    unsigned total = 0;
    for (const float r : residuals) {
        const float bin = std::abs(r) * (kBins / 2.F);
        if (!(bin < kBins)) continue;
        ++histogram[static_cast<std::size_t>(bin)];
        ++total;
    }
    if (total == 0) return 0.;
    double below = 0.;
    std::size_t bin = 0;
    while (below + histogram[bin] < 0.5 * total) below += histogram[bin++];
    const double inBin = (0.5 * total - below) / histogram[bin];
    return 1.4826 * (static_cast<double>(bin) + inBin) * 2. / kBins;
}

ViewComparison::ViewComparison(const Camera& camera, const PhotometricOptions& photometric,
                               ModelNoise noise)
    : camera_(camera), photometric_(photometric), noise_(noise) {
    if (photometric.stride != 1) {
        throw std::invalid_argument("alignment: uses every pixel, stride must be 1");
    }
    if (camera.width < 3 || camera.height < 3) {
        throw std::invalid_argument("alignment: image below 3 x 3 pixels");
    }
    const std::size_t vectors = (camera.width - 2 + kWidth - 1) / kWidth;
    pitch_ = vectors * kWidth + 2;
    const std::size_t size = pitch_ * camera.height;
    intensity_.assign(size, 0.F);
    inverseDepth_.assign(size, kNoSurface);
    observed_.assign(size, 0.F);
    residual_.assign(size, kUnused);
}

double ViewComparison::robustSigma() const { return robustSigmaOf(residual_); }

void ViewComparison::load(const View& predicted, const ImageF& observed) {
    const auto fits = [&](const ImageF& image) {
        return image.getWidth() == camera_.width && image.getHeight() == camera_.height;
    };
    if (!fits(predicted.intensity) || !fits(predicted.depth) || !fits(observed)) {
        throw std::invalid_argument("alignment: image and camera differ in size");
    }
    double sum = 0.;
    std::size_t surfaces = 0;
    for (unsigned v = 0; v < camera_.height; ++v) {
        std::copy_n(predicted.intensity[v], camera_.width, &intensity_[v * pitch_]);
        std::copy_n(observed[v], camera_.width, &observed_[v * pitch_]);
        const float* depth = predicted.depth[v];
        float* inverse = &inverseDepth_[v * pitch_];
        float rowSum = 0.F;
        for (unsigned u = 0; u < camera_.width; ++u) {
            const bool surface = depth[u] > 0.F;
            inverse[u] = surface ? 1.F / depth[u] : kNoSurface;
            rowSum += surface ? inverse[u] : 0.F;
            surfaces += surface ? 1 : 0;
        }
        sum += rowSum;
    }
    meanInverseDepth_ = surfaces > 0 ? sum / static_cast<double>(surfaces) : 0.;
}

/// A sixteenth of the pixels used in the last comparison.
GradientNoise ViewComparison::pointsSeen() const {
    GradientNoise noise;
    for (unsigned v = 1; v + 1 < camera_.height; v += 4) {
        for (unsigned u = 1; u + 1 < camera_.width; u += 4) {
            const std::size_t i = v * pitch_ + u;
            if (residual_[i] == kUnused) continue;
            noise.add((u - camera_.cx()) / camera_.fx(), (v - camera_.cy()) / camera_.fy(),
                      inverseDepth_[i]);
        }
    }
    return noise;
}

NormalEquations ViewComparison::operator()(const View& predicted, const ImageF& observed,
                                           const Exposure& exposure, const Loss& loss) {
    load(predicted, observed);
    const RowInput in{intensity_, inverseDepth_, observed_, pitch_};
    const auto jump = static_cast<float>(photometric_.depthJump);
    const auto saturation = static_cast<float>(photometric_.saturation);
    const auto aspect = static_cast<float>(camera_.fy() / camera_.fx());
    const auto gain = static_cast<float>(exposure.gain);
    const auto offset = static_cast<float>(exposure.offset);
    const float perColumn = static_cast<float>(1. / camera_.fx());

    ProductSums sums(loss, pitch_ / kWidth);
    Float notSharedX{}, notSharedY{};
    const bool isNoisy = noise_ == ModelNoise::measured;
    for (unsigned v = 1; v + 1 < camera_.height; ++v) {
        const auto y = static_cast<float>((v - camera_.cy()) / camera_.fy());
        sums.beginRow();
        for (unsigned u = 1; u + 1 < camera_.width; u += kWidth) {
            const std::size_t i = v * pitch_ + u;
            const Int used = counts(in, i, jump, saturation);
            const Float I = at(intensity_, i);
            const Float r = at(observed_, i) - (gain * I + offset);
            const Float w = at(inverseDepth_, i);
            const Float gx =
                used ? at(intensity_, i + 1) - at(intensity_, i - 1) : simd::splat(0.F);
            const Float gy =
                used ? aspect * (at(intensity_, i + pitch_) - at(intensity_, i - pitch_))
                     : simd::splat(0.F);
            const Float x = (simd::ramp() + (static_cast<float>(u - camera_.cx()))) * perColumn;
            const Float s = x * gx + y * gy;
            if (isNoisy) {
                const Float du = at(observed_, i + 1) - at(observed_, i - 1);
                const Float dv = at(observed_, i + pitch_) - at(observed_, i - pitch_);
                notSharedX += gx * (gx - du / gain);
                notSharedY += gy * (gy - aspect * dv / gain);
            }
            simd::store(&residual_[i], used ? r : simd::splat(kUnused));
            sums.add({gx * w, gy * w, s * w, y * s + gy, x * s + gx, x * gy - y * gx, I}, r, used);
        }
        sums.endRow();
    }
    const Vector8 unit = columnUnits(exposure.gain, camera_.fx());
    NormalEquations equations = sums.result(unit);
    equations.meanInverseDepth = meanInverseDepth_;
    if (isNoisy) {
        // A map's grey values are means of many. Other differences between map and image, as
        // between cells, must not be taken for noise.
        const double most = kMaxNoise * photometric_.sigma * photometric_.sigma;
        pointsSeen().subtractFrom(equations, {simd::sum(notSharedX), simd::sum(notSharedY)}, most,
                                  unit.head<6>());
    }
    return equations;
}

}  // namespace photonav
