// SPDX-License-Identifier: BSD-3-Clause
// Vectorised sums of products over image rows, for normal equations. Included by .cpp files only.
#pragma once

#include <array>
#include <cstring>
#include <numeric>
#include <vector>

#include "alignment/normal_equations.hpp"
#include "photometry/simd.hpp"

namespace photonav {

/// Inverse depth of a pixel without a surface: finite, but fails every test for a surface.
inline constexpr float kNoSurface = -1e30F;

/// Residual of an unused pixel: larger than any difference of grey values.
inline constexpr float kUnused = 4.F;

/// Factors on the columns (J, predicted grey value, 1) that the kernels leave out: half the focal
/// length, the signs of J and -gain.
inline Vector8 columnUnits(double gain, double focal) {
    Vector8 unit;
    unit << 1., 1., -1., -1., 1., 1., 1., 1.;
    unit.head<6>() *= -0.5 * gain * focal;
    return unit;
}

/// Accumulates the upper triangle of sum w c^T c for c = (7 columns, 1, residual), with the weights
/// w of a robust loss. Sums are single precision within a few rows and double across them.
/// @tparam withBlur whether c has one more column at its end: b of BlurSums
template <bool withBlur = false>
class ProductSums {
  public:
    using Columns = std::array<simd::Float, 7>;

    /// @param vectors largest number of vectors that one row adds
    ProductSums(const Loss& loss, std::size_t vectors)
        : kind_(loss.kind), width_(static_cast<float>(loss.width())) {
        row_.reserve(vectors);
    }

    /// Begins other sums after a result(), in the same memory.
    void restart() {
        sums_ = {};
        plainSums_ = {};
    }

    void beginRow() { row_.clear(); }

    /// Adds the pixels of one vector to the present row.
    /// @param used lanes to sum; the columns of other lanes must be finite as well
    /// @param byBlur b of BlurSums; must be finite
    void add(const Columns& columns, const simd::Float& residual, const simd::Int& used,
             [[maybe_unused]] const simd::Float& byBlur = simd::splat(0.F)) {
        const simd::Float zero = simd::splat(0.F);
        const simd::Float one = used ? simd::splat(1.F) : zero;
        const simd::Float r = used ? residual : zero;
        const auto [weight, rho] = weigh(r);
        Pixels& pixels = row_.emplace_back();
        pixels.weight = weight * one;
        std::copy(columns.begin(), columns.end(), pixels.column.begin());
        pixels.column[7] = one;
        pixels.column[8] = r;
        if constexpr (withBlur) pixels.column[9] = byBlur;
        plain_[0] += one;
        plain_[1] += r;
        plain_[2] += r * r;
        plain_[3] += rho;
        plain_[4] += pixels.column[6] * one;
        plain_[5] += pixels.column[6] * pixels.column[6] * one;
        plain_[6] += pixels.column[6] * r;
    }

    /// Adds the products of the present row to the sums. Done in several passes, because 45 sums
    /// and their factors do not fit in 16 registers.
    void endRow() {
        addProducts<0, 1>();
        addProducts<1, 2>();
        addProducts<2, 3>();
        addProducts<3, 5>();
        addProducts<5, kColumns>();
        if (++rowsInLanes_ == kRowsInLanes) flush();
    }

    /// The normal equations of all rows so far.
    /// @param unit factors on the eight columns, see columnUnits()
    NormalEquations result(const Vector8& unit) {
        flush();
        NormalEquations e;
        for (int i = 0; i < 8; ++i) {
            for (int j = i; j < 8; ++j) {
                e.AtA(i, j) = unit[i] * unit[j] * sums_[i][j];
                e.AtA(j, i) = e.AtA(i, j);
            }
            e.Atr[i] = unit[i] * sums_[i][8];
            if constexpr (withBlur) e.byBlur.Atb[i] = unit[i] * sums_[i][9];
        }
        if constexpr (withBlur) {
            e.byBlur.btr = sums_[8][9];
            e.byBlur.btb = sums_[9][9];
        }
        e.count = plainSums_[0];
        e.sum = plainSums_[1];
        e.sumSquares = plainSums_[2];
        e.loss = plainSums_[3];
        e.sumPredicted = plainSums_[4];
        e.sumPredictedSquares = plainSums_[5];
        e.sumPredictedTimesR = plainSums_[6];
        return e;
    }

  private:
    static constexpr int kColumns = withBlur ? 10 : 9;
    static constexpr int kRowsInLanes = 4;
    struct Pixels {
        simd::Float weight;
        std::array<simd::Float, kColumns> column;
    };

    /// Weight and loss of residuals; rho = r^2 where the weight is one.
    std::pair<simd::Float, simd::Float> weigh(const simd::Float& r) const {
        const simd::Float one = simd::splat(1.F);
        const simd::Float size = simd::abs(r);
        if (kind_ == RobustWeight::huber) {
            return {size > width_ ? width_ / size : one,
                    size > width_ ? width_ * (2.F * size - width_) : r * r};
        }
        if (kind_ == RobustWeight::tukey) {
            const simd::Float t = one - r * r * (1.F / (width_ * width_));
            const simd::Float inside = simd::max(t, simd::splat(0.F));
            return {inside * inside, width_ * width_ / 3.F * (one - inside * inside * inside)};
        }
        return {one, r * r};
    }

    template <int kFirst, int kEnd>
    void addProducts() {
        std::array<std::array<simd::Float, kColumns>, kEnd - kFirst> sums = {};
        for (const Pixels& p : row_) {
#pragma GCC unroll 10
            for (int i = kFirst; i < kEnd; ++i) {
                const simd::Float weighted = p.weight * p.column[i];
#pragma GCC unroll 10
                for (int j = i; j < kColumns; ++j) sums[i - kFirst][j] += weighted * p.column[j];
            }
        }
#pragma GCC unroll 10
        for (int i = kFirst; i < kEnd; ++i) {
#pragma GCC unroll 10
            for (int j = i; j < kColumns; ++j) lanes_[i][j] += sums[i - kFirst][j];
        }
    }

    static double total(const simd::Float& lanes) {
        std::array<float, simd::kWidth> lane;
        std::memcpy(lane.data(), &lanes, sizeof(lane));
        return std::accumulate(lane.begin(), lane.end(), 0.);
    }

    void flush() {
        for (int i = 0; i < kColumns; ++i) {
            for (int j = i; j < kColumns; ++j) sums_[i][j] += total(lanes_[i][j]);
        }
        for (std::size_t i = 0; i < plain_.size(); ++i) plainSums_[i] += total(plain_[i]);
        lanes_ = {};
        plain_ = {};
        rowsInLanes_ = 0;
    }

    RobustWeight kind_;
    float width_;
    std::vector<Pixels> row_;
    std::array<std::array<simd::Float, kColumns>, kColumns> lanes_ = {};
    std::array<simd::Float, 7> plain_ = {};
    std::array<std::array<double, kColumns>, kColumns> sums_ = {};
    std::array<double, 7> plainSums_ = {};
    int rowsInLanes_ = 0;
};

}  // namespace photonav
