// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/keyframe_points.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "alignment/product_sums.hpp"
#include "geometry/se3.hpp"
#include "photometry/simd.hpp"

namespace photonav {

namespace {

using simd::Float;
using simd::Int;
using simd::kWidth;

constexpr std::size_t kChunk = 32;       ///< vectors whose products are summed together
constexpr std::size_t kSampleEvery = 4;  ///< residuals of every n-th chunk are kept
constexpr std::size_t kNoiseEvery = 16;  ///< noise is estimated from every n-th point
constexpr float kLeastMeasured = 2.5F;  ///< of 2 x 2 depths: otherwise the pixel shows other things

double square(double x) { return x * x; }

Float at(const float* p) { return simd::load<Float>(p); }

/// An image between its pixels.
struct Sample {
    Float grey;
    Float du, dv;  ///< gradient [grey value per pixel]
};

/// At (u, v), both within [0, size - 1).
Sample bilinear(const ImageF& image, const Float& u, const Float& v) {
    const Int column = simd::toInt(u);
    const Int row = simd::toInt(v);
    const Float du = u - simd::toFloat(column);
    const Float dv = v - simd::toFloat(row);
    const Int index = row * static_cast<int>(image.getWidth()) + column;
    const float* base = image.bitmap;
    const float* below = base + image.getWidth();
    const auto pixel = [&](const float* from) {
        return reinterpret_cast<Float>(simd::gather<4>(from, index));
    };
    const Float left = pixel(base), right = pixel(base + 1);
    const Float downLeft = pixel(below) - left, downRight = pixel(below + 1) - right;
    const Float atLeft = left + dv * downLeft;
    const Float across = right + dv * downRight - atLeft;
    return {atLeft + du * across, across, downLeft + du * (downRight - downLeft)};
}

/// Elements first, first + 2, ... of two vectors one after the other.
template <int... kLane>
Float everySecond(const Float& a, const Float& b, int first,
                  std::integer_sequence<int, kLane...> /*lanes*/) {
    return first == 0 ? __builtin_shufflevector(a, b, (2 * kLane)...)
                      : __builtin_shufflevector(a, b, (2 * kLane + 1)...);
}

/// out[u] = merge of a[2u], a[2u + 1], b[2u], b[2u + 1].
template <class Merge>
void halveRows(const float* a, const float* b, float* out, unsigned width, const Merge& merge) {
    const auto columns = [](const float* row, int first) {
        return everySecond(at(row), at(row + kWidth), first,
                           std::make_integer_sequence<int, kWidth>());
    };
    unsigned u = 0;
    for (; u + kWidth <= width; u += kWidth) {
        const std::size_t from = 2 * std::size_t(u);
        simd::store(out + u, merge(columns(a + from, 0), columns(a + from, 1), columns(b + from, 0),
                                   columns(b + from, 1)));
    }
    for (; u < width; ++u) {
        const std::size_t from = 2 * std::size_t(u);
        out[u] = merge(simd::splat(a[from]), simd::splat(a[from + 1]), simd::splat(b[from]),
                       simd::splat(b[from + 1]))[0];
    }
}

/// The equations for xi' with xi = P xi'.
template <class Equations>
void substitute(Equations& e, const Matrix6& P) {
    // Products of this size are slower by the general algorithm, which packs its factors.
    const Matrix6 half = e.AtA.template topLeftCorner<6, 6>().lazyProduct(P);
    const Eigen::Matrix<double, 6, 2> mixed =
        P.transpose().lazyProduct(e.AtA.template topRightCorner<6, 2>());
    e.AtA.template topLeftCorner<6, 6>() = P.transpose().lazyProduct(half);
    e.AtA.template topRightCorner<6, 2>() = mixed;
    e.AtA.template bottomLeftCorner<2, 6>() = mixed.transpose();
    e.Atr.template head<6>() = P.transpose().lazyProduct(e.Atr.template head<6>()).eval();
}

/// Inverse depths of a keyframe, row by row.
std::vector<float> inverseDepths(const ImageF& depth) {
    std::vector<float> inverse(depth.getSize());
    for (std::size_t i = 0; i < inverse.size(); ++i) {
        const float z = depth.bitmap[i];
        inverse[i] = z > 0.F ? 1.F / z : kNoSurface;
    }
    return inverse;
}

}  // namespace

ImageF halvedByMean(const ImageF& image) {
    ImageF half(image.getHeight() / 2, image.getWidth() / 2);
    for (unsigned v = 0; v < half.getHeight(); ++v) {
        halveRows(image[2 * v], image[2 * v + 1], half[v], half.getWidth(),
                  [](const Float& a, const Float& b, const Float& c, const Float& d) {
                      return 0.25F * ((a + b) + (c + d));
                  });
    }
    return half;
}

ImageF halvedDepth(const ImageF& depth, float spread) {
    ImageF half(depth.getHeight() / 2, depth.getWidth() / 2);
    const auto merge = [&](const Float& a, const Float& b, const Float& c, const Float& d) {
        const Float zero = simd::splat(0.F), one = simd::splat(1.F), far = simd::splat(1e30F);
        const auto orFar = [&](const Float& z) { return z > 0.F ? z : far; };
        const auto isThere = [&](const Float& z) { return z > 0.F ? one : zero; };
        const Float nearest =
            simd::min(simd::min(orFar(a), orFar(b)), simd::min(orFar(c), orFar(d)));
        const Float farthest = simd::max(simd::max(a, b), simd::max(c, d));
        const Float count = (isThere(a) + isThere(b)) + (isThere(c) + isThere(d));
        const Float mean = ((a + b) + (c + d)) / simd::max(count, one);
        const Int isSurface = (farthest <= nearest * (1.F + spread)) & (count > kLeastMeasured);
        return isSurface ? mean : zero;
    };
    for (unsigned v = 0; v < half.getHeight(); ++v) {
        halveRows(depth[2 * v], depth[2 * v + 1], half[v], half.getWidth(), merge);
    }
    return half;
}

/// Values of an image row from which points are chosen; column u at index u.
struct PointSet::Row {
    std::vector<float> inverseDepth, gx, gy;
    std::vector<std::int32_t> used;
    const float* intensity = nullptr;
    float y = 0.F;

    explicit Row(std::size_t width) : inverseDepth(width), gx(width), gy(width), used(width, 0) {}
};

/// Which pixels become points.
struct PointSet::Rule {
    float jump, dark, aspect, least, nearerThan, fartherThan;

    Rule(const Camera& camera, const KeyframeOptions& options)
        : jump(static_cast<float>(
              std::min(options.alignment.photometric.depthJump, options.maxBend / camera.fx()))),
          dark(static_cast<float>(options.alignment.photometric.saturation)),
          aspect(static_cast<float>(camera.fy() / camera.fx())),
          least(static_cast<float>(4. * square(options.minGradient))),
          nearerThan(static_cast<float>(1. / options.maxDepth)),
          fartherThan(static_cast<float>(1. / options.minDepth)) {}

    /// @param W inverse depths of row v, within those of the image
    void apply(const ImageF& intensity, unsigned v, const float* W, Row& row) const {
        const unsigned width = intensity.getWidth();
        const float* aboveW = W - width;
        const float* belowW = W + width;
        const float* I = intensity[v];
        const float* above = intensity[v - 1];
        const float* below = intensity[v + 1];
        row.intensity = I;
        for (unsigned u = 1; u + 1 < width; ++u) {
            const float horizontal = std::abs(W[u - 1] + W[u + 1] - 2.F * W[u]);
            const float vertical = std::abs(aboveW[u] + belowW[u] - 2.F * W[u]);
            const float du = I[u + 1] - I[u - 1];
            const float dv = below[u] - above[u];
            row.inverseDepth[u] = W[u];
            row.gx[u] = du;
            row.gy[u] = aspect * dv;
            row.used[u] = (W[u] >= nearerThan) & (W[u] <= fartherThan) &
                          (std::max(horizontal, vertical) <= jump * W[u]) & (I[u] > dark) &
                          (I[u] < 1.F - dark) & (du * du + dv * dv >= least);
        }
    }
};

PointSet::PointSet(const View& view, const Camera& camera, const KeyframeOptions& options)
    : camera_(camera),
      maxNoise_(2. * square(options.alignment.photometric.sigma) +
                2. * square(options.minGradient)) {
    const unsigned width = camera.width;
    const std::size_t capacity = std::size_t(width) * camera.height + kWidth;
    for (auto* field : {&x_, &y_, &w_, &intensity_, &gx_, &gy_}) field->resize(capacity);

    const Rule rule(camera, options);
    const std::vector<float> inverse = inverseDepths(view.depth);
    const unsigned side = ImageBlock::side(camera);
    std::vector<Row> band(side, Row(width));
    for (unsigned top = 1; top + 1 < camera.height; top += side) {
        const unsigned bottom = std::min(top + side, camera.height - 1);
        for (unsigned v = top; v < bottom; ++v) {
            Row& row = band[v - top];
            row.y = static_cast<float>((v - camera.cy()) / camera.fy());
            rule.apply(view.intensity, v, &inverse[std::size_t(v) * width], row);
        }
        for (unsigned left = 1; left + 1 < width; left += side) {
            blockBegin_.push_back(size_);
            blockIndex_.emplace_back(left / side, top / side);
            const unsigned right = std::min(left + side, width - 1);
            for (unsigned v = top; v < bottom; ++v) append(band[v - top], left, right);
        }
    }
    blockBegin_.push_back(size_);
    finish();
}

/// Means over the points, and padding: a block is read by whole vectors from where it begins.
void PointSet::finish() {
    const std::size_t padded = (size_ + 2 * kWidth - 1) / kWidth * kWidth;
    double sum = 0.;
    for (std::size_t i = 0; i < size_; ++i) sum += w_[i];
    meanInverseDepth_ = size_ > 0 ? sum / static_cast<double>(size_) : 0.;
    for (auto* field : {&x_, &y_, &w_, &intensity_, &gx_, &gy_}) {
        field->resize(size_);  // append() has left a pixel beyond
        field->resize(padded, field == &x_ ? 1e6F : 0.F);
    }
    for (std::size_t i = 0; i < size_; i += kNoiseEvery) noise_.add(x_[i], y_[i], w_[i]);
}

/// Columns left to right - 1. Writes every pixel; a pixel that is not used is overwritten by the
/// next one. This avoids branches that cannot be predicted.
void PointSet::append(const Row& row, unsigned left, unsigned right) {
    std::size_t n = size_;
    const auto perColumn = static_cast<float>(1. / camera_.fx());
    const auto centre = static_cast<float>(camera_.cx());
    for (unsigned u = left; u < right; ++u) {
        x_[n] = (static_cast<float>(u) - centre) * perColumn;
        y_[n] = row.y;
        w_[n] = row.inverseDepth[u];
        intensity_[n] = row.intensity[u];
        gx_[n] = row.gx[u];
        gy_[n] = row.gy[u];
        n += static_cast<std::size_t>(row.used[u]);
    }
    size_ = n;
}

/// Where points of a keyframe are in another image, and what they differ by.
struct PointSet::Projection {
    Projection(const PointSet& keyframe, const ImageF& image, const Pose& T_c_k,
               const Exposure& exposure)
        : points(keyframe),
          observed(image),
          R(T_c_k.linear().cast<float>()),
          t(T_c_k.translation().cast<float>()),
          fx(static_cast<float>(keyframe.camera_.fx())),
          fy(static_cast<float>(keyframe.camera_.fy())),
          cx(static_cast<float>(keyframe.camera_.cx())),
          cy(static_cast<float>(keyframe.camera_.cy())),
          gain(static_cast<float>(exposure.gain)),
          offset(static_cast<float>(exposure.offset)),
          right(static_cast<float>(keyframe.camera_.width) - 1.001F),
          bottom(static_cast<float>(keyframe.camera_.height) - 1.001F) {}

    struct Points {
        ProductSums<>::Columns columns;
        Float r, gx, gy, inverseDepth;
        Float du, dv;  ///< gradient of the image there [grey value per pixel]
        Int inView;
    };
    Points operator()(std::size_t k) const {
        const Float x = at(&points.x_[k]), y = at(&points.y_[k]), w = at(&points.w_[k]);
        const Float px = R(0, 0) * x + R(0, 1) * y + (R(0, 2) + t[0] * w);
        const Float py = R(1, 0) * x + R(1, 1) * y + (R(1, 2) + t[1] * w);
        const Float pz = R(2, 0) * x + R(2, 1) * y + (R(2, 2) + t[2] * w);
        const Float inverse = 1.F / pz;
        const Float u = fx * px * inverse + cx;
        const Float v = fy * py * inverse + cy;
        const Int inView = (pz > 0.01F) & (u >= 0.F) & (u < right) & (v >= 0.F) & (v < bottom);
        const Float I = at(&points.intensity_[k]);
        const Sample seen = bilinear(observed, inView ? u : Float{}, inView ? v : Float{});
        const Float gx = at(&points.gx_[k]), gy = at(&points.gy_[k]);
        const Float s = x * gx + y * gy;
        return {{gx * w, gy * w, s * w, y * s + gy, x * s + gx, x * gy - y * gx, I},
                seen.grey - (gain * I + offset),
                gx,
                gy,
                inverse,
                seen.du,
                seen.dv,
                inView};
    }

    const PointSet& points;
    const ImageF& observed;
    Eigen::Matrix3f R;
    Eigen::Vector3f t;
    float fx, fy, cx, cy, gain, offset, right, bottom;
};

NormalEquations PointSet::compare(const ImageF& observed, const Pose& T_c_k,
                                  const Exposure& exposure, const Loss& loss) {
    const Projection project(*this, observed, T_c_k, exposure);
    const Eigen::Matrix3f& R = project.R;
    const float aspect = project.fy / project.fx;
    Float noiseX{}, noiseY{};

    ProductSums<> sums(loss, kChunk);
    residualSample_.clear();
    const std::size_t vectors = x_.size() / kWidth;
    for (std::size_t begin = 0; begin < vectors; begin += kChunk) {
        sums.beginRow();
        const bool keep = begin / kChunk % kSampleEvery == 0;
        for (std::size_t i = begin; i < std::min(begin + kChunk, vectors); ++i) {
            const auto p = project(i * kWidth);
            // Noise is the difference to the observed gradient, rotated into the keyframe.
            const Float perPixel = p.inView ? 2.F / project.gain * p.inverseDepth : Float{};
            const Float du = perPixel * p.du, dv = perPixel * aspect * p.dv;
            noiseX += p.gx * ((p.inView ? p.gx : Float{}) - (R(0, 0) * du + R(1, 0) * dv));
            noiseY += p.gy * ((p.inView ? p.gy : Float{}) - (R(0, 1) * du + R(1, 1) * dv));
            sums.add(p.columns, p.r, p.inView);
            if (keep) {
                residualSample_.resize(residualSample_.size() + kWidth);
                simd::store(&residualSample_[residualSample_.size() - kWidth],
                            p.inView ? p.r : simd::splat(kUnused));
            }
        }
        sums.endRow();
    }
    const Vector8 unit = columnUnits(exposure.gain, camera_.fx());
    NormalEquations equations = sums.result(unit);
    equations.meanInverseDepth = meanInverseDepth_;
    const Matrix8 withoutNoise = noise_.subtractFrom(
        equations, {simd::sum(noiseX), simd::sum(noiseY)}, maxNoise_, unit.head<6>());
    const Matrix6 onTheRight = adjoint(T_c_k.inverse());
    substitute(equations, onTheRight);
    ofPoints_ = withoutNoise.topLeftCorner<6, 6>() * onTheRight;
    return equations;
}

std::vector<ImageBlock> PointSet::blocks(const ImageF& observed, const Pose& T_c_k,
                                         const Exposure& exposure, const Loss& loss) const {
    const Projection project(*this, observed, T_c_k, exposure);
    const Vector8 unit = columnUnits(exposure.gain, camera_.fx());
    const std::size_t side = ImageBlock::side(camera_);
    ProductSums<> sums(loss, side * side / kWidth + 1);
    std::vector<ImageBlock> blocks;
    blocks.reserve(blockIndex_.size());
    for (std::size_t block = 0; block + 1 < blockBegin_.size(); ++block) {
        const std::size_t begin = blockBegin_[block], end = blockBegin_[block + 1];
        if (begin == end) continue;
        sums.restart();
        sums.beginRow();
        for (std::size_t k = begin; k < end; k += kWidth) {
            const auto p = project(k);
            sums.add(p.columns, p.r, p.inView & (simd::ramp() < static_cast<float>(end - k)));
        }
        sums.endRow();
        const NormalEquations e = sums.result(unit);
        if (e.count < 1.) continue;
        ImageBlock& added = blocks.emplace_back();
        added.AtA = e.AtA;
        added.Atr = e.Atr;
        added.index = blockIndex_[block];
        added.count = e.count;
        substitute(added, ofPoints_);
    }
    return blocks;
}

}  // namespace photonav
