// SPDX-License-Identifier: BSD-3-Clause
// Squared distances to obstacles on a grid of cells, updated when obstacles change.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "geometry/types.hpp"

namespace photonav {

/// Exact squared Euclidean distance between the centres of cells, up to a limit, computed one axis
/// after the other (the lower envelopes of Felzenszwalb and Huttenlocher, Distance Transforms of
/// Sampled Functions, 2012). The result of every axis is stored: an update recomputes only cells
/// within `reach` of a changed obstacle, and for the next axis only cells that this has changed.
///
/// Obstacles are set on the `outer` cells: the inner cells and `reach` more cells on every side.
/// Distances are computed for the inner cells. At first there are no obstacles.
class DistanceTransform {
  public:
    static constexpr int kBlock = 32;  ///< number of cells along x that are computed together

    DistanceTransform() = default;
    /// @param inner number of inner cells along each axis
    /// @param reach upper limit of the distances [cells], at most 180
    DistanceTransform(const Eigen::Array3i& inner, int reach);

    /// Memory of a transform with these parameters [bytes].
    static double bytes(const Eigen::Array3d& inner, double reach);

    bool empty() const { return column_.empty(); }
    Eigen::Array3i outer() const { return inner_ + 2 * reach_; }  ///< number along each axis

    /// Makes the outer cells from `first` up to, not including, `last` obstacles or free. Parts
    /// outside the outer cells are ignored.
    void set(const Eigen::Array3i& first, const Eigen::Array3i& last, bool isObstacle);

    /// Sets 4 x 4 x 4 outer cells from `first` on, x fastest.
    void setBlock(const Eigen::Array3i& first, const std::array<bool, 64>& isObstacle);

    /// Receives the squared distances [cells^2] of the inner cells (x ... x + n - 1, y, z).
    using Visit =
        std::function<void(int x, int y, int z, int n, const std::uint16_t* squaredDistances)>;

    /// Updates the distances after calls of set() and setBlock().
    /// @param visit called for all cells whose squared distance changed, and for some whose squared
    ///        distance did not change; before the first update all are reach^2
    void update(const Visit& visit);

  private:
    struct Range {  // empty unless low <= high
        int low = 1, high = 0;

        void extend(int i) {
            const bool isFirst = low > high;
            low = isFirst ? i : std::min(low, i);
            high = isFirst ? i : std::max(high, i);
        }
    };

    std::uint8_t* column(int x, int y, int z) {
        return column_.data() + (std::ptrdiff_t(z) * (inner_.y() + 2 * reach_) + y) * pitch_ + x;
    }
    std::uint16_t* plane(int x, int y, int z) {
        return plane_.data() + (std::ptrdiff_t(y) * inner_.z() + z) * pitch_ + x;
    }
    void setCell(std::uint8_t* row, int x, int y, int z, bool isObstacle);
    void updateColumns(int block, int z, const Range& changed);
    void updatePlane(int block, int y);
    void updateRows(int y, int z, const Visit& visit);

    Eigen::Array3i inner_ = Eigen::Array3i::Zero();
    int reach_ = 0;
    int pitch_ = 0;                     // cells of a row of outer cells, in whole blocks
    std::vector<std::uint8_t> column_;  // along y, x fastest, then y, then z; 0: an obstacle
    std::vector<std::uint16_t>
        plane_;  // squared, along y and z, of inner y and z; x, then z, then y

    std::vector<Range> changedCells_;          // of y, by z and block, z fastest
    std::vector<std::uint8_t> changedColumn_;  // z (outer) fastest, then block, then y (inner)
    std::vector<std::uint8_t> changedPlane_;   // block fastest, then z (inner), then y (inner)
    struct {
        Range block, y, z;
    } reached_;                           // by an update: beyond it nothing has changed
    std::vector<std::uint8_t> todo_;      // of one line
    std::vector<std::uint16_t> squares_;  // of one block in x, outer z
};

}  // namespace photonav
