// SPDX-License-Identifier: BSD-3-Clause
#include "photometry/photometric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "geometry/se3.hpp"
#include "photometry/simd.hpp"

namespace photonav {

namespace {

using simd::Float;
using simd::Int;

// --- Which pixels are used: written once, for a float and for a vector of them -------------------

/// Inverse depth of a pixel without surface. It fails the test below but is finite, so that its
/// product with zero is zero.
constexpr float kNoSurface = -1e30F;

template <typename T>
T inverseDepthOf(T depth) {
    const T inverse = 1.F / depth;
    return depth > 0.F ? inverse : T{} + kNoSurface;
}

float magnitude(float a) { return std::abs(a); }
Float magnitude(const Float& a) {
    return reinterpret_cast<Float>(reinterpret_cast<Int>(a) & 0x7fffffff);
}

/// Inverse depth is linear along any line on a plane, however oblique: its second difference shows
/// edges. Taken from the centre, so that neighbours can stay in memory.
template <typename T>
T curvature(T before, T centre, T after) {
    return magnitude((centre - before) + (centre - after));
}

/// False where one of the five has no surface.
template <typename T>
auto isSmooth(T horizontal, T vertical, T limit) {
    return (horizontal > vertical ? horizontal : vertical) <= limit;
}

/// @param contrast half the range of grey values that are not saturated
template <typename T>
auto isExposed(T intensity, T contrast) {
    return magnitude(intensity - 0.5F) < contrast;
}

float contrastOf(const PhotometricOptions& options) {
    return static_cast<float>(0.5 - options.saturation);
}

/// First row and column in use: the border of one pixel and half a stride.
int firstInStride(int stride) { return 1 + stride / 2; }

/// Where in its pixel a gradient is, right of and below the centre [pixels].
double shiftOf(GradientStencil gradient) { return gradient == GradientStencil::square ? 0.5 : 0.; }

/// Harmonic mean over the diagonal of the image (near surfaces have most of the information); 0
/// without any surface.
float typicalDepth(const View& view) {
    constexpr unsigned kSamples = 16;
    float inverse = 0.F;
    unsigned surfaces = 0;
    for (unsigned k = 0; k < kSamples; ++k) {
        const float depth =
            view.depth[k * view.depth.getHeight() / kSamples][k * view.depth.getWidth() / kSamples];
        if (!(depth > 0.F)) continue;
        inverse += 1.F / depth;
        ++surfaces;
    }
    return inverse > 0.F ? static_cast<float>(surfaces) / inverse : 0.F;
}

// --- The kernel -------------------------------------------------------------------------------

/// Computes the rows J of one image row after the other and sums their products. Works in vectors
/// of columns; the last vector ends with the last usable column and skips columns that the vector
/// before it contains. Needs images wider than a vector.
///
/// Rotations are about a point in view, not about the camera: rotations about the camera look much
/// like translations, and single precision would lose the difference.
class Kernel {
  public:
    static constexpr std::size_t kMinWidth = simd::kWidth + 2;

    Kernel(const View& view, const Camera& camera, const PhotometricOptions& options)
        : view_(view),
          camera_(camera),
          jump_(static_cast<float>(options.depthJump)),
          gradient_(options.gradient),
          width_(camera.width),
          vectors_((width_ - 2 + simd::kWidth - 1) / simd::kWidth),
          pivot_(typicalDepth(view)),
          x_(width_),
          contrast_(vectors_, Float{}),
          jacobian_(vectors_) {
        for (auto& row : inverseDepth_) row.resize(width_);
        for (std::size_t u = 0; u < width_; ++u) {
            const double column = static_cast<double>(u) + shiftOf(gradient_);
            x_[u] = static_cast<float>((column - camera.cx()) / camera.fx());
        }
        float* contrast = reinterpret_cast<float*>(contrast_.data());
        const std::size_t lanes = vectors_ * simd::kWidth;
        const std::size_t tail = lanes - simd::kWidth;  // first lane of the last vector
        for (std::size_t u = firstInStride(options.stride); u + 1 < width_; u += options.stride) {
            contrast[u <= tail ? u - 1 : u + lanes - (width_ - 1)] = contrastOf(options);
        }
    }

    /// Adds row v; rows come in ascending order, blank ones may be left out.
    void add(unsigned v) {
        for (next_ = std::max(next_, v - 1); next_ <= v + 1; ++next_) {
            for (std::size_t i = 0; i <= vectors_; ++i) invert(next_, i);
        }
        if (gradient_ == GradientStencil::square)
            fill<GradientStencil::square>(v);
        else
            fill<GradientStencil::central>(v);
        // The divisions for the row after next run during the first pass: they take long but leave
        // other units free.
        const unsigned ahead = std::min(next_++, camera_.height - 1);
        addProducts<0>([this, ahead](std::size_t i) { invert(ahead, i); });
        invert(ahead, vectors_);
        [this]<std::size_t... kPass>(std::index_sequence<kPass...>) {
            (addProducts<1 + kPass>([](std::size_t) {}), ...);
        }
        (std::make_index_sequence<kProducts.size() / kPerPass - 1>());
        if (++rowsInLanes_ == kRowsInLanes) flush();
    }

    /// sum J^T J over all rows added
    Matrix6 sum() {
        flush();
        Matrix6 sum;
        for (std::size_t k = 0; k < kProducts.size(); ++k) {
            const double* lanes = wideLanes_.data() + k * simd::kWidth;
            sum(kProducts[k].i, kProducts[k].j) = std::accumulate(lanes, lanes + simd::kWidth, 0.);
        }
        sum(1, 4) = sum(0, 3) + sum(2, 5);  // J = (a, p x a), so that a . (p x a) = 0
        sum = Matrix6(sum.selfadjointView<Eigen::Upper>());
        Pose toPivot = Pose::Identity();
        toPivot.translation().z() = -static_cast<double>(pivot_);
        Vector6 unit;  // factors that fill() leaves out
        unit << camera_.fx(), camera_.fy(), -camera_.fx(), -camera_.fy(), camera_.fx(),
            camera_.fy();
        const Matrix6 motion = 0.5 * unit.asDiagonal() * adjoint(toPivot);
        sum = Matrix6(motion.transpose() * sum * motion);
        return sum.selfadjointView<Eigen::Upper>();
    }

  private:
    using Row = std::array<Float, 6>;

    /// Rows summed in single precision, each lane on its own, before they go to double precision.
    static constexpr int kRowsInLanes = 16;

    /// The products that are summed: 20, since the 21st follows.
    struct Product {
        int i, j;
    };
    static constexpr std::array<Product, 20> kProducts = {
        {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}, {1, 1}, {1, 2}, {1, 3}, {1, 5},
         {2, 2}, {2, 3}, {2, 4}, {2, 5}, {3, 3}, {3, 4}, {3, 5}, {4, 4}, {4, 5}, {5, 5}}};
    /// Several passes, because 20 sums and their factors do not fit in 16 registers; without
    /// three-operand instructions fewer do.
    static constexpr std::size_t kPerPass = simd::kWidth > 4 ? 10 : 5;

    float* inverseDepth(unsigned v) { return inverseDepth_[v % inverseDepth_.size()].data(); }

    /// Inverse depth of the i-th vector of row v; the one after the last ends with the row.
    void invert(unsigned v, std::size_t i) {
        const std::size_t u = std::min(i * simd::kWidth, width_ - simd::kWidth);
        simd::store(inverseDepth(v) + u, inverseDepthOf(simd::load<Float>(view_.depth[v] + u)));
    }

    template <GradientStencil kGradient>
    void fill(unsigned v) {
        // x and y are scaled by the ratio of the focal lengths where the gradients would have to be
        const double row = v + shiftOf(kGradient) - camera_.cy();
        const float yOfGradient = static_cast<float>(row / camera_.fx());
        const float y = static_cast<float>(row * camera_.fx() / (camera_.fy() * camera_.fy()));
        const float jump = jump_;
        const float pivot = pivot_;
        const float* I = view_.intensity[v];
        const float* aboveI = view_.intensity[v - 1];
        const float* belowI = view_.intensity[v + 1];
        const float* W = inverseDepth(v);
        const float* aboveW = inverseDepth(v - 1);
        const float* belowW = inverseDepth(v + 1);
        const float* xs = x_.data();
        const std::size_t last = width_ - 1 - simd::kWidth;
        for (std::size_t i = 0; i < vectors_; ++i) {
            const std::size_t u = std::min(1 + i * simd::kWidth, last);
            const auto at = [u](const float* p) { return simd::load<Float>(p + u); };
            const Float w = at(W);
            const Int counts =
                isSmooth<Float>(curvature<Float>(at(W - 1), w, at(W + 1)),
                                curvature<Float>(at(aboveW), w, at(belowW)), jump * w) &
                isExposed<Float>(at(I), contrast_[i]);
            const auto masked = [&counts](const Float& value) {
                return reinterpret_cast<Float>(reinterpret_cast<Int>(value) & counts);
            };
            Float gx, gy;
            if constexpr (kGradient == GradientStencil::square) {
                const Float falling = at(belowI + 1) - at(I), rising = at(I + 1) - at(belowI);
                gx = masked(falling + rising);
                gy = masked(falling - rising);
            } else {
                gx = masked(at(I + 1) - at(I - 1));
                gy = masked(at(belowI) - at(aboveI));
            }
            const Float x = at(xs);
            const Float s = x * gx + yOfGradient * gy;
            const Float a = gx * w;
            const Float b = gy * w;
            jacobian_[i] = {
                a, b, s * w, (y * s + gy) - pivot * b, (x * s + gx) - pivot * a, x * gy - y * gx};
        }
    }

    /// Adds the products of one pass to the lanes; `alongside` is called for every vector.
    template <std::size_t kPass, typename Alongside>
    void addProducts(const Alongside& alongside) {
        constexpr const Product* kProduct = kProducts.data() + kPass * kPerPass;
        std::array<Float, kPerPass> sums = {};
        for (std::size_t i = 0; i < vectors_; ++i) {
            alongside(i);
            const Row& J = jacobian_[i];
#pragma GCC unroll 10
            for (std::size_t k = 0; k < kPerPass; ++k)
                sums[k] += J[kProduct[k].i] * J[kProduct[k].j];
        }
        for (std::size_t k = 0; k < kPerPass; ++k) lanes_[kPass * kPerPass + k] += sums[k];
    }

    void flush() {
        const float* lanes = reinterpret_cast<const float*>(lanes_.data());
        for (std::size_t k = 0; k < wideLanes_.size(); ++k) {
            wideLanes_[k] += static_cast<double>(lanes[k]);
        }
        lanes_ = {};
        rowsInLanes_ = 0;
    }

    const View& view_;
    const Camera& camera_;
    float jump_;
    GradientStencil gradient_;
    std::size_t width_, vectors_;
    float pivot_;  ///< depth of the point that rotations are about, on the optical axis
    std::vector<float> x_;
    std::vector<Float> contrast_;                     ///< zero where a lane is not in use
    std::array<std::vector<float>, 4> inverseDepth_;  ///< the stencil and the row to come
    unsigned next_ = 0;                               ///< row whose inverse depth comes next
    std::vector<Row> jacobian_;                       ///< of the current row
    int rowsInLanes_ = 0;
    std::array<Float, kProducts.size()> lanes_ = {};
    std::array<double, kProducts.size()* simd::kWidth> wideLanes_ = {};
};

/// Whether row v has no gradient. Not inlined: the kernel needs all registers.
[[gnu::noinline]] bool isBlank(const ImageF& intensity, unsigned v, GradientStencil gradient) {
    const bool isSquare = gradient == GradientStencil::square;
    const float* I = intensity[v] + (isSquare ? 1 : 0);
    const float* above = intensity[isSquare ? v : v - 1] + 1;
    const std::size_t bytes = (intensity.getWidth() - 2) * sizeof(float);
    return *above == intensity[v + 1][1] && std::memcmp(intensity[v] + 2, I, bytes) == 0 &&
           std::memcmp(above, intensity[v + 1] + 1, bytes) == 0;
}

double weight(const PhotometricOptions& options) {
    return options.scale * options.stride * options.stride / (options.sigma * options.sigma);
}

/// [1/pixel]
Eigen::RowVector2d gradientAt(const ImageF& I, unsigned u, unsigned v, GradientStencil gradient) {
    const auto difference = [&I](unsigned v1, unsigned u1, unsigned v0, unsigned u0) {
        return static_cast<double>(I[v1][u1]) - I[v0][u0];
    };
    if (gradient == GradientStencil::central) {
        return {0.5 * difference(v, u + 1, v, u - 1), 0.5 * difference(v + 1, u, v - 1, u)};
    }
    return {0.5 * (difference(v, u + 1, v, u) + difference(v + 1, u + 1, v + 1, u)),
            0.5 * (difference(v + 1, u, v, u) + difference(v + 1, u + 1, v, u + 1))};
}

/// For images narrower than a vector.
Matrix6 sumOverPixels(const View& view, const Camera& camera, const PhotometricOptions& options) {
    Matrix6 sum = Matrix6::Zero();
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            const Vector6 J = pixelJacobian(view, camera, u, v, options);
            sum += J * J.transpose();
        }
    }
    return sum;
}

}  // namespace

Matrix6 photometricInformation(const View& view, const Camera& camera,
                               const PhotometricOptions& options) {
    if (view.intensity.getWidth() != camera.width || view.intensity.getHeight() != camera.height ||
        view.depth.getWidth() != camera.width || view.depth.getHeight() != camera.height) {
        throw std::invalid_argument("photometric information: view and camera differ in size");
    }
    if (options.stride < 1) throw std::invalid_argument("photometric information: stride below 1");
    if (camera.width < 3 || camera.height < 3) return Matrix6::Zero();
    if (camera.width < Kernel::kMinWidth) {
        return weight(options) * sumOverPixels(view, camera, options);
    }
    Kernel kernel(view, camera, options);
    for (unsigned v = firstInStride(options.stride); v + 1 < camera.height; v += options.stride) {
        if (!isBlank(view.intensity, v, options.gradient)) kernel.add(v);
    }
    return weight(options) * kernel.sum();
}

Vector6 pixelJacobian(const View& view, const Camera& camera, unsigned u, unsigned v,
                      const PhotometricOptions& options) {
    const auto inStride = [&](unsigned pixel, unsigned size) {
        const unsigned first = firstInStride(options.stride);
        return pixel >= first && pixel + 1 < size && (pixel - first) % options.stride == 0;
    };
    if (!inStride(u, camera.width) || !inStride(v, camera.height)) return Vector6::Zero();

    const ImageF& I = view.intensity;
    const auto W = [&](unsigned row, unsigned column) {
        return inverseDepthOf(view.depth[row][column]);
    };
    const float w = W(v, u);
    if (!isSmooth(curvature(W(v, u - 1), w, W(v, u + 1)), curvature(W(v - 1, u), w, W(v + 1, u)),
                  static_cast<float>(options.depthJump) * w) ||
        !isExposed(I[v][u], contrastOf(options))) {
        return Vector6::Zero();
    }

    const Eigen::RowVector2d g = gradientAt(I, u, v, options.gradient);
    const double shift = shiftOf(options.gradient);
    const Eigen::Vector3d p = camera.unproject(u + shift, v + shift, view.depth[v][u]);
    Eigen::Matrix<double, 3, 6> motion;  // d p / d xi = [1 | -p^]
    motion << Eigen::Matrix3d::Identity(), -hat(p);
    return (g * camera.projectionJacobian(p) * motion).transpose();
}

ImageF contributionImage(const View& view, const Camera& camera, const Vector6& direction,
                         const PhotometricOptions& options) {
    ImageF image(camera.height, camera.width, 0.F);
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            const double change = pixelJacobian(view, camera, u, v, options).dot(direction);
            image[v][u] = static_cast<float>(weight(options) * change * change);
        }
    }
    return image;
}

ImageF contributionImage(const View& view, const Camera& camera,
                         const PhotometricOptions& options) {
    double depth = 0.;
    unsigned surfaces = 0;
    for (unsigned i = 0; i < view.depth.getSize(); ++i) {
        if (view.depth.bitmap[i] > 0.F) {
            depth += view.depth.bitmap[i];
            ++surfaces;
        }
    }
    ImageF image(camera.height, camera.width, 0.F);
    if (surfaces == 0) return image;
    const double perMetre = surfaces / depth;
    Vector6 unit = Vector6::Ones();
    unit.tail<3>().setConstant(perMetre);
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            const Vector6 J = pixelJacobian(view, camera, u, v, options).cwiseProduct(unit);
            image[v][u] = static_cast<float>(weight(options) * J.squaredNorm());
        }
    }
    return image;
}

}  // namespace photonav
