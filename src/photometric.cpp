// SPDX-License-Identifier: BSD-3-Clause
#include "photometric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <vector>

#include "se3.hpp"

namespace photonav {

namespace {

// One vector register of the instruction set this file is compiled for.
#if defined(__AVX512F__)
constexpr int kLanes = 16;
#elif defined(__AVX2__)
constexpr int kLanes = 8;
#else
constexpr int kLanes = 4;
#endif

template <int kWidth>
struct Simd {
    // typedef: g++ drops the attribute from an alias when the size depends on a parameter.
    typedef float Float __attribute__((vector_size(kWidth * sizeof(float))));
};

// --- Which pixels count: written once, for a float and for a vector of them -------------------

/// 1 / depth; NaN, which fails every test below, where there is no surface.
float inverseDepth(float depth) {
    return depth > 0.F ? 1.F / depth : std::numeric_limits<float>::quiet_NaN();
}

/// Inverse depth is linear along any line on a plane, however oblique: its second difference shows
/// edges. False when one of the three is NaN.
template <typename T>
auto isSmooth(T before, T centre, T after, T limit) {
    const T curvature = before + after - 2.F * centre;
    return (curvature <= limit) & (-curvature <= limit);
}

template <typename T>
auto isExposed(T intensity, float saturation) {
    return (intensity > saturation) & (intensity < 1.F - saturation);
}

/// First row and column in use: the border of one pixel and half a stride.
int firstInStride(int stride) { return 1 + stride / 2; }

// --- The kernel -------------------------------------------------------------------------------

/// Three consecutive rows of intensity and inverse depth, padded so that whole vectors can be
/// read. The padding has no depth, so it does not count.
class RowWindow {
  public:
    RowWindow(const View& view, int padding)
        : view_(view), width_(view.intensity.getWidth()), pitch_(width_ + padding) {
        intensity_.resize(3 * pitch_, 0.F);
        inverseDepth_.resize(3 * pitch_, std::numeric_limits<float>::quiet_NaN());
    }

    /// Brings in row v; it can be read until row v + 3 comes.
    void load(unsigned v) {
        const std::size_t start = (v % 3) * pitch_;
        std::copy_n(view_.intensity[v], width_, &intensity_[start]);
        const float* depth = view_.depth[v];
        for (std::size_t u = 0; u < width_; ++u) inverseDepth_[start + u] = inverseDepth(depth[u]);
    }

    const float* intensity(unsigned v) const { return &intensity_[(v % 3) * pitch_]; }
    const float* inverseDepthRow(unsigned v) const { return &inverseDepth_[(v % 3) * pitch_]; }

  private:
    const View& view_;
    std::size_t width_;
    std::size_t pitch_;
    std::vector<float> intensity_;
    std::vector<float> inverseDepth_;
};

/// The Jacobian of one image row, column by column of J, and its products summed over the row.
template <int kWidth>
class RowKernel {
  public:
    using Float = typename Simd<kWidth>::Float;

    RowKernel(const Camera& camera, const PhotometricOptions& options)
        : camera_(camera), options_(options) {
        const std::size_t columns = camera.width + kWidth;
        x_.resize(columns, 0.F);
        halfFx_.resize(columns, 0.F);
        halfFy_.resize(columns, 0.F);
        const int first = firstInStride(options.stride);
        for (int u = first; u + 1 < static_cast<int>(camera.width); ++u) {
            x_[u] = static_cast<float>((u - camera.cx()) / camera.fx());
            if ((u - first) % options.stride != 0) continue;
            halfFx_[u] = static_cast<float>(0.5 * camera.fx());
            halfFy_[u] = static_cast<float>(0.5 * camera.fy());
        }
        vectors_ = (camera.width - 2 + kWidth - 1) / kWidth;
        jacobian_.resize(vectors_);
    }

    void add(const RowWindow& rows, unsigned v, Matrix6& sum) {
        fill(rows, v);
        // Two passes, because 21 sums and the factors do not fit in 16 registers.
        addProducts<0, 2>(sum);
        addProducts<2, 6>(sum);
    }

  private:
    static Float load(const float* p) {
        Float f;
        std::memcpy(&f, p, sizeof(f));
        return f;
    }

    void fill(const RowWindow& rows, unsigned v) {
        const float y = static_cast<float>((v - camera_.cy()) / camera_.fy());
        const float jump = static_cast<float>(options_.depthJump);
        const float saturation = static_cast<float>(options_.saturation);
        const float* I = rows.intensity(v);
        const float* W = rows.inverseDepthRow(v);
        const float* above = rows.intensity(v - 1);
        const float* below = rows.intensity(v + 1);
        const float* aboveW = rows.inverseDepthRow(v - 1);
        const float* belowW = rows.inverseDepthRow(v + 1);
        const Float zero = {};
        for (std::size_t i = 0; i < vectors_; ++i) {
            const std::size_t u = 1 + i * kWidth;
            Float w = load(W + u);
            const Float limit = jump * w;
            const auto counts = isSmooth(load(W + u - 1), w, load(W + u + 1), limit) &
                                isSmooth(load(aboveW + u), w, load(belowW + u), limit) &
                                isExposed(load(I + u), saturation);
            w = counts ? w : zero;
            Float gx = (load(I + u + 1) - load(I + u - 1)) * load(&halfFx_[u]);
            Float gy = (load(below + u) - load(above + u)) * load(&halfFy_[u]);
            gx = counts ? gx : zero;
            gy = counts ? gy : zero;
            const Float x = load(&x_[u]);
            const Float s = x * gx + y * gy;
            jacobian_[i] = {gx * w, gy * w, -s * w, -(y * s + gy), x * s + gx, x * gy - y * gx};
        }
    }

    template <int kFirst, int kEnd>
    void addProducts(Matrix6& sum) const {
        Float products[6][6] = {};
        for (const std::array<Float, 6>& J : jacobian_) {
#pragma GCC unroll 6
            for (int i = kFirst; i < kEnd; ++i) {
#pragma GCC unroll 6
                for (int j = i; j < 6; ++j) products[i][j] += J[i] * J[j];
            }
        }
        for (int i = kFirst; i < kEnd; ++i) {
            for (int j = i; j < 6; ++j) {
                std::array<float, kWidth> lanes;
                std::memcpy(lanes.data(), &products[i][j], sizeof(lanes));
                sum(i, j) += std::accumulate(lanes.begin(), lanes.end(), 0.F);
            }
        }
    }

    const Camera& camera_;
    const PhotometricOptions& options_;
    std::vector<float> x_, halfFx_, halfFy_;  ///< 0 in columns that the stride skips
    std::size_t vectors_ = 0;
    std::vector<std::array<Float, 6>> jacobian_;
};

double weight(const PhotometricOptions& options) {
    return options.scale * options.stride * options.stride / (options.sigma * options.sigma);
}

bool hasInterior(const View& view) {
    return view.intensity.getWidth() >= 3 && view.intensity.getHeight() >= 3;
}

}  // namespace

Matrix6 photometricInformation(const View& view, const Camera& camera,
                               const PhotometricOptions& options) {
    Matrix6 sum = Matrix6::Zero();
    if (!hasInterior(view)) return sum;
    RowWindow rows(view, kLanes);
    RowKernel<kLanes> kernel(camera, options);
    const unsigned first = firstInStride(options.stride);
    unsigned next = 0;
    for (unsigned v = first; v + 1 < camera.height; v += options.stride) {
        for (next = std::max(next, v - 1); next <= v + 1; ++next) rows.load(next);
        kernel.add(rows, v, sum);
    }
    return weight(options) * Matrix6(sum.selfadjointView<Eigen::Upper>());
}

Vector6 pixelJacobian(const View& view, const Camera& camera, unsigned u, unsigned v,
                      const PhotometricOptions& options) {
    const auto inStride = [&](unsigned pixel, unsigned size) {
        const unsigned first = firstInStride(options.stride);
        return pixel >= first && pixel + 1 < size && (pixel - first) % options.stride == 0;
    };
    if (!inStride(u, camera.width) || !inStride(v, camera.height)) return Vector6::Zero();

    const auto inverseDepthAt = [&](unsigned row, unsigned column) {
        return inverseDepth(view.depth[row][column]);
    };
    const ImageF& I = view.intensity;
    const float w = inverseDepthAt(v, u);
    const float limit = static_cast<float>(options.depthJump) * w;
    if (!isSmooth(inverseDepthAt(v, u - 1), w, inverseDepthAt(v, u + 1), limit) ||
        !isSmooth(inverseDepthAt(v - 1, u), w, inverseDepthAt(v + 1, u), limit) ||
        !isExposed(I[v][u], static_cast<float>(options.saturation))) {
        return Vector6::Zero();
    }

    const double gu = 0.5 * (static_cast<double>(I[v][u + 1]) - I[v][u - 1]);
    const double gv = 0.5 * (static_cast<double>(I[v + 1][u]) - I[v - 1][u]);
    const double Z = view.depth[v][u];
    const Eigen::Vector3d p((u - camera.cx()) / camera.fx() * Z,
                            (v - camera.cy()) / camera.fy() * Z, Z);
    Eigen::Matrix<double, 2, 3> projection;                             // d pi / d p
    projection << camera.fx() / Z, 0., -camera.fx() * p.x() / (Z * Z),  //
        0., camera.fy() / Z, -camera.fy() * p.y() / (Z * Z);
    Eigen::Matrix<double, 3, 6> motion;  // d p / d xi = [1 | -p^]
    motion << Eigen::Matrix3d::Identity(), -hat(p);
    return (Eigen::RowVector2d(gu, gv) * projection * motion).transpose();
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
