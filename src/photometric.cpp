// SPDX-License-Identifier: BSD-3-Clause
#include "photometric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "se3.hpp"
#include "simd.hpp"

namespace photonav {

namespace {

template <int kWidth>
struct Simd {
    // typedef: g++ drops the attribute from an alias when the size depends on a parameter.
    typedef float Float __attribute__((vector_size(kWidth * sizeof(float))));
    typedef double Double __attribute__((vector_size(kWidth * sizeof(double))));

    static Float loadUnaligned(const float* p) {
        Float f;
        std::memcpy(&f, p, sizeof(f));
        return f;
    }
};

// --- Which pixels count: written once, for a float and for a vector of them -------------------

/// Stands for the inverse depth of nothing: fails every test below, yet is finite, so that zero
/// times it is zero.
constexpr float kNoSurface = -1e30F;

float inverseDepthOf(float depth) { return depth > 0.F ? 1.F / depth : kNoSurface; }

/// Inverse depth is linear along any line on a plane, however oblique: its second difference shows
/// edges. False when one of the three is no surface.
template <typename T>
T curvature(T before, T centre, T after) {
    const T c = before + after - 2.F * centre;
    return c > -c ? c : -c;
}

template <typename T>
auto isSmooth(T horizontal, T vertical, T limit) {
    return (horizontal > vertical ? horizontal : vertical) <= limit;
}

template <typename T>
auto isExposed(T intensity, float saturation) {
    return (intensity > saturation) & (intensity < 1.F - saturation);
}

/// First row and column in use: the border of one pixel and half a stride.
int firstInStride(int stride) { return 1 + stride / 2; }

// --- The kernel -------------------------------------------------------------------------------

/// Four consecutive rows of intensity and inverse depth in whole, aligned vectors: lane 0 of
/// vector 0 is column 1, the first that can count. The padding has no surface, so it does not.
template <int kWidth>
class RowWindow {
  public:
    using Float = typename Simd<kWidth>::Float;

    explicit RowWindow(const View& view)
        : view_(view),
          width_(view.intensity.getWidth()),
          vectors_((width_ - 2 + kWidth - 1) / kWidth),
          intensity_(kRows * (vectors_ + 2), Float{}),
          inverseDepth_(kRows * (vectors_ + 2), Float{} + kNoSurface) {}

    std::size_t vectors() const { return vectors_; }

    /// Brings in row v; it can be read until row v + 4 comes.
    void load(unsigned v) {
        float* intensity = reinterpret_cast<float*>(&intensity_[start(v)]);
        float* inverse = reinterpret_cast<float*>(&inverseDepth_[start(v)]);
        const float* depth = view_.depth[v];
        std::copy_n(view_.intensity[v], width_, intensity - 1);
        inverse[-1] = inverseDepthOf(depth[0]);
        for (std::size_t u = 1; u < width_; ++u) inverse[u - 1] = inverseDepthOf(depth[u]);
    }

    const Float* intensity(unsigned v) const { return &intensity_[start(v)]; }
    const Float* inverseDepth(unsigned v) const { return &inverseDepth_[start(v)]; }

  private:
    /// One more than the stencil: a row is written while the one before it is read, since reading
    /// in other units what was just written stalls.
    static constexpr unsigned kRows = 4;

    std::size_t start(unsigned v) const { return (v % kRows) * (vectors_ + 2) + 1; }

    const View& view_;
    std::size_t width_;
    std::size_t vectors_;
    std::vector<Float> intensity_, inverseDepth_;
};

/// J of one image row after the other, and the sum of its products.
template <int kWidth>
class RowKernel {
  public:
    using Float = typename Simd<kWidth>::Float;
    using Double = typename Simd<kWidth>::Double;

    RowKernel(const Camera& camera, const PhotometricOptions& options, std::size_t vectors)
        : camera_(camera),
          options_(options),
          x_(vectors),
          inStride_(vectors, Float{}),
          jacobian_(vectors) {
        float* x = reinterpret_cast<float*>(x_.data());
        float* inStride = reinterpret_cast<float*>(inStride_.data());
        for (unsigned u = 1; u <= vectors * kWidth; ++u) {
            x[u - 1] = static_cast<float>((u - camera.cx()) / camera.fx());
        }
        for (unsigned u = firstInStride(options.stride); u + 1 < camera.width;
             u += options.stride) {
            inStride[u - 1] = 1.F;
        }
    }

    void add(const RowWindow<kWidth>& rows, unsigned v) {
        fill(rows, v);
        if (options_.stride > 1) applyStride();
        // Two passes, because 21 sums and their factors do not fit in 16 registers.
        addProducts<0, 2>();
        addProducts<2, 6>();
        if (++rowsInLanes_ == kRowsInLanes) flush();
    }

    /// sum J^T J over all rows added
    Matrix6 sum() {
        flush();
        Vector6 unit;  // what fill() leaves out: half the focal length and two signs
        unit << 1., 1., -1., -1., 1., 1.;
        unit *= 0.5 * camera_.fx();
        Matrix6 sum;
        for (int i = 0; i < 6; ++i) {
            for (int j = i; j < 6; ++j) {
                std::array<double, kWidth> lane;
                std::memcpy(lane.data(), &wideLanes_[i][j], sizeof(lane));
                sum(i, j) = unit[i] * unit[j] * std::accumulate(lane.begin(), lane.end(), 0.);
                sum(j, i) = sum(i, j);
            }
        }
        return sum;
    }

  private:
    using Row = std::array<Float, 6>;

    /// Rows summed in single precision, each lane on its own, before they go to double precision.
    static constexpr int kRowsInLanes = 4;

    void fill(const RowWindow<kWidth>& rows, unsigned v) {
        const auto lanesBefore = [](const Float* p) {
            return Simd<kWidth>::loadUnaligned(reinterpret_cast<const float*>(p) - 1);
        };
        const auto lanesAfter = [](const Float* p) {
            return Simd<kWidth>::loadUnaligned(reinterpret_cast<const float*>(p) + 1);
        };
        const float y = static_cast<float>((v - camera_.cy()) / camera_.fy());
        const float aspect = static_cast<float>(camera_.fy() / camera_.fx());
        const float jump = static_cast<float>(options_.depthJump);
        const float saturation = static_cast<float>(options_.saturation);
        const Float* I = rows.intensity(v);
        const Float* above = rows.intensity(v - 1);
        const Float* below = rows.intensity(v + 1);
        const Float* W = rows.inverseDepth(v);
        const Float* aboveW = rows.inverseDepth(v - 1);
        const Float* belowW = rows.inverseDepth(v + 1);
        for (std::size_t i = 0; i < jacobian_.size(); ++i) {
            const Float w = W[i];
            const auto counts =
                isSmooth<Float>(curvature<Float>(lanesBefore(W + i), w, lanesAfter(W + i)),
                                curvature<Float>(aboveW[i], w, belowW[i]), jump * w) &
                isExposed(I[i], saturation);
            const Float gx = counts ? lanesAfter(I + i) - lanesBefore(I + i) : Float{};
            const Float gy = counts ? aspect * (below[i] - above[i]) : Float{};
            const Float x = x_[i];
            const Float s = x * gx + y * gy;
            jacobian_[i] = {gx * w, gy * w, s * w, y * s + gy, x * s + gx, x * gy - y * gx};
        }
    }

    void applyStride() {
        for (std::size_t i = 0; i < jacobian_.size(); ++i) {
            for (Float& column : jacobian_[i]) column *= inStride_[i];
        }
    }

    /// Adds the products of columns i in [kFirst, kEnd) with columns j >= i to the lanes.
    template <int kFirst, int kEnd>
    void addProducts() {
        std::array<Row, 6> sums = {};
        for (const Row& J : jacobian_) {
#pragma GCC unroll 6
            for (int i = kFirst; i < kEnd; ++i) {
#pragma GCC unroll 6
                for (int j = i; j < 6; ++j) sums[i][j] += J[i] * J[j];
            }
        }
#pragma GCC unroll 6
        for (int i = kFirst; i < kEnd; ++i) {
#pragma GCC unroll 6
            for (int j = i; j < 6; ++j) lanes_[i][j] += sums[i][j];
        }
    }

    void flush() {
        for (int i = 0; i < 6; ++i) {
            for (int j = i; j < 6; ++j) {
                wideLanes_[i][j] += __builtin_convertvector(lanes_[i][j], Double);
            }
        }
        lanes_ = {};
        rowsInLanes_ = 0;
    }

    const Camera& camera_;
    const PhotometricOptions& options_;
    std::vector<Float> x_, inStride_;
    std::vector<Row> jacobian_;  ///< of the current row
    int rowsInLanes_ = 0;
    std::array<std::array<Double, 6>, 6> wideLanes_ = {};
    std::array<Row, 6> lanes_ = {};
};

double weight(const PhotometricOptions& options) {
    return options.scale * options.stride * options.stride / (options.sigma * options.sigma);
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
    RowWindow<simd::kWidth> rows(view);
    RowKernel<simd::kWidth> kernel(camera, options, rows.vectors());
    const unsigned first = firstInStride(options.stride);
    unsigned next = 0;
    for (unsigned v = first; v + 1 < camera.height; v += options.stride) {
        const unsigned ahead = std::min(v + 2, camera.height - 1);
        for (next = std::max(next, v - 1); next <= ahead; ++next) rows.load(next);
        kernel.add(rows, v);
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
