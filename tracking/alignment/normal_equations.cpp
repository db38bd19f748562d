// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/normal_equations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "alignment/product_sums.hpp"
#include "photometry/simd.hpp"

namespace photonav {

namespace {

constexpr unsigned kTile = 8;  // edge of a GradientTile [pixels]

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

/// By central differences over two pixels, of used pixels.
struct Gradient {
    Float x, y;
};
Gradient gradientAt(const std::vector<float>& intensity, std::size_t i, std::size_t pitch,
                    float aspect, const Int& used) {
    const Float zero = simd::splat(0.F);
    return {used ? at(intensity, i + 1) - at(intensity, i - 1) : zero,
            used ? aspect * (at(intensity, i + pitch) - at(intensity, i - pitch)) : zero};
}

/// Half of the Laplacian.
Float changeByBlur(const std::vector<float>& intensity, std::size_t i, std::size_t pitch) {
    const Float around = at(intensity, i + 1) + at(intensity, i - 1) + at(intensity, i + pitch) +
                         at(intensity, i - pitch);
    return 0.5F * around - 2.F * at(intensity, i);
}

/// Columns of A for pixels (u, v), (u + 1, v) ..., but for columnUnits().
struct Kernel {
    explicit Kernel(const Camera& c)
        : camera(c),
          aspect(static_cast<float>(c.fy() / c.fx())),
          perColumn(static_cast<float>(1. / c.fx())) {}

    ProductSums<true>::Columns columns(unsigned u, unsigned v, const Gradient& g, const Float& w,
                                       const Float& I) const {
        const auto y = static_cast<float>((v - camera.cy()) / camera.fy());
        const Float x = (simd::ramp() + static_cast<float>(u - camera.cx())) * perColumn;
        const Float s = x * g.x + y * g.y;
        return {g.x * w, g.y * w, s * w, y * s + g.y, x * s + g.x, x * g.y - y * g.x, I};
    }

    const Camera& camera;
    float aspect, perColumn;
};

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

NormalEquations withoutBlur(NormalEquations e, double sigma, double noise) {
    const BlurSums& b = e.byBlur;
    const double variance = b.variance(sigma, noise);
    const double gained = variance * b.btr * b.btr;
    e.AtA -= variance * b.Atb * b.Atb.transpose();
    e.Atr -= variance * b.btr * b.Atb;
    e.loss -= gained;
    e.sumSquares -= gained;
    return e;
}

std::vector<ImageBlock> withoutBlur(std::vector<ImageBlock> blocks, double sigma, double noise) {
    BlurSums all;
    for (const ImageBlock& block : blocks) {
        all.btb += block.byBlur.btb;
        all.btr += block.byBlur.btr;
    }
    const double blur = all.btr * all.variance(sigma, noise);
    for (ImageBlock& block : blocks) block.Atr -= blur * block.byBlur.Atb;
    return blocks;
}

ViewComparison::ViewComparison(const Camera& camera, const PhotometricOptions& photometric,
                               IsStopped isStopped)
    : camera_(camera), photometric_(photometric), isStopped_(std::move(isStopped)) {
    if (photometric.stride != 1) {
        throw std::invalid_argument("alignment: uses every pixel, stride must be 1");
    }
    if (camera.width < 3 || camera.height < 3) {
        throw std::invalid_argument("alignment: image below 3 x 3 pixels");
    }
    const std::size_t vectors = (camera.width - 2 + kWidth - 1) / kWidth;
    pitch_ = vectors * kWidth + 2;
}

/// With the first views, not before: an aligner has many sizes and kinds of comparison, and most of
/// its images need few of them.
void ViewComparison::allocate() {
    const std::size_t size = pitch_ * camera_.height + kWidth;  // blocks read beyond the last row
    const auto make = [&](std::vector<float>& image, float value) {
        throwIfStopped(isStopped_);  // memory takes longer than what is done with it
        image.assign(size, value);
    };
    make(residual_, kUnused);
    make(inverseDepth_, kNoSurface);
    make(observed_, 0.F);
    make(intensity_, 0.F);  // the last one: load() takes it as the sign that all are there
}

double ViewComparison::robustSigma() const { return robustSigmaOf(residual_); }

void ViewComparison::load(const View& predicted, const ImageF& observed) {
    const auto fits = [&](const ImageF& image) {
        return image.getWidth() == camera_.width && image.getHeight() == camera_.height;
    };
    if (!fits(predicted.intensity) || !fits(predicted.depth) || !fits(observed)) {
        throw std::invalid_argument("alignment: image and camera differ in size");
    }
    if (intensity_.empty()) allocate();
    double sum = 0.;
    std::size_t surfaces = 0;
    for (unsigned v = 0; v < camera_.height; ++v) {
        throwIfStopped(isStopped_);
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

/// Of the pixels that counted in the last call.
GradientTile ViewComparison::tileAt(unsigned left, unsigned top, double gain) const {
    const unsigned right = std::min(left + kTile, camera_.width - 1);
    const unsigned bottom = std::min(top + kTile, camera_.height - 1);
    const double aspect = camera_.fy() / camera_.fx();
    GradientTile tile;
    for (unsigned v = top; v < bottom; ++v) {
        for (unsigned u = left; u < right; ++u) {
            const std::size_t i = v * pitch_ + u;
            if (residual_[i] == kUnused) continue;
            const auto gradientOf = [&](const std::vector<float>& I) {
                return Eigen::Vector2d(I[i + 1] - I[i - 1],
                                       aspect * (I[i + pitch_] - I[i - pitch_]));
            };
            const Eigen::Vector2d g = gradientOf(intensity_), o = gradientOf(observed_) / gain;
            tile.model += g * g.transpose();
            tile.shared += 0.5 * (g * o.transpose() + o * g.transpose());
            tile.observed += o.squaredNorm();
            tile.x += (u - camera_.cx()) / camera_.fx();
            tile.y += (v - camera_.cy()) / camera_.fy();
            tile.inverseDepth += inverseDepth_[i];
            ++tile.pixels;
        }
    }
    if (tile.pixels == 0) return tile;
    tile.x /= tile.pixels;
    tile.y /= tile.pixels;
    tile.inverseDepth /= tile.pixels;
    return tile;
}

std::vector<GradientTile> ViewComparison::tiles(const Exposure& exposure) const {
    std::vector<GradientTile> tiles;
    for (unsigned top = 1; top + 1 < camera_.height; top += kTile) {
        for (unsigned left = 1; left + 1 < camera_.width; left += kTile) {
            const GradientTile tile = tileAt(left, top, exposure.gain);
            if (tile.inverseDepth > 0.) tiles.push_back(tile);
        }
    }
    return tiles;
}

std::vector<ImageBlock> ViewComparison::blocks(const Exposure& exposure, const Loss& loss) const {
    const unsigned side = ImageBlock::side(camera_);
    const Vector8 unit = columnUnits(exposure.gain, camera_.fx());
    const auto gain = static_cast<float>(exposure.gain);
    const Kernel kernel(camera_);
    ProductSums<true> sums(loss, std::size_t(side) * ((side + kWidth - 1) / kWidth));
    std::vector<ImageBlock> blocks;
    blocks.reserve(std::size_t(ImageBlock::numberIn(camera_).prod()));
    for (unsigned top = 1; top + 1 < camera_.height; top += side) {
        const unsigned bottom = std::min(top + side, camera_.height - 1);
        for (unsigned left = 1; left + 1 < camera_.width; left += side) {
            const unsigned right = std::min(left + side, camera_.width - 1);
            sums.restart();
            sums.beginRow();
            for (unsigned v = top; v < bottom; ++v) {
                for (unsigned u = left; u < right; u += kWidth) {
                    const std::size_t i = v * pitch_ + u;
                    const Float r = at(residual_, i);
                    const Int inBlock = simd::ramp() < static_cast<float>(right - u);
                    const Int used = (r < kUnused) & inBlock;
                    const Gradient g = gradientAt(intensity_, i, pitch_, kernel.aspect, used);
                    sums.add(kernel.columns(u, v, g, at(inverseDepth_, i), at(intensity_, i)), r,
                             used, gain * changeByBlur(intensity_, i, pitch_));
                }
            }
            sums.endRow();
            const NormalEquations e = sums.result(unit);
            if (e.count < 1.) continue;
            blocks.push_back({e.AtA,
                              e.Atr,
                              e.byBlur,
                              {left / side, top / side},
                              normalAt((left + right) / 2, (top + bottom) / 2),
                              e.count});
        }
    }
    return blocks;
}

/// Of the plane through a pixel and its neighbours, 1/z = a x + b y + c, away from the camera.
Eigen::Vector3d ViewComparison::normalAt(unsigned u, unsigned v) const {
    const std::size_t i =
        std::clamp(v, 1U, camera_.height - 2) * pitch_ + std::clamp(u, 1U, camera_.width - 2);
    const double x = (u - camera_.cx()) / camera_.fx(), y = (v - camera_.cy()) / camera_.fy();
    const auto w = [&](std::size_t k) { return static_cast<double>(inverseDepth_[k]); };
    const double least = std::min({w(i), w(i - 1), w(i + 1), w(i - pitch_), w(i + pitch_)});
    if (least <= 0.) return Eigen::Vector3d::Zero();
    const double a = 0.5 * camera_.fx() * (w(i + 1) - w(i - 1));
    const double b = 0.5 * camera_.fy() * (w(i + pitch_) - w(i - pitch_));
    return Eigen::Vector3d(a, b, w(i) - a * x - b * y).normalized();
}

NormalEquations ViewComparison::operator()(const View& predicted, const ImageF& observed,
                                           const Exposure& exposure, const Loss& loss) {
    load(predicted, observed);
    const RowInput in{intensity_, inverseDepth_, observed_, pitch_};
    const auto jump = static_cast<float>(photometric_.depthJump);
    const auto saturation = static_cast<float>(photometric_.saturation);
    const auto gain = static_cast<float>(exposure.gain);
    const auto offset = static_cast<float>(exposure.offset);
    const Kernel kernel(camera_);
    const float aspect = kernel.aspect;

    ProductSums<true> sums(loss, pitch_ / kWidth);
    for (unsigned v = 1; v + 1 < camera_.height; ++v) {
        throwIfStopped(isStopped_);
        sums.beginRow();
        for (unsigned u = 1; u + 1 < camera_.width; u += kWidth) {
            const std::size_t i = v * pitch_ + u;
            const Int used = counts(in, i, jump, saturation);
            const Float I = at(intensity_, i);
            const Float r = at(observed_, i) - (gain * I + offset);
            const Gradient g = gradientAt(intensity_, i, pitch_, aspect, used);
            simd::store(&residual_[i], used ? r : simd::splat(kUnused));
            sums.add(kernel.columns(u, v, g, at(inverseDepth_, i), I), r, used,
                     gain * changeByBlur(intensity_, i, pitch_));
        }
        sums.endRow();
    }
    const Vector8 unit = columnUnits(exposure.gain, camera_.fx());
    NormalEquations equations = sums.result(unit);
    equations.meanInverseDepth = meanInverseDepth_;
    return equations;
}

}  // namespace photonav
