// SPDX-License-Identifier: BSD-3-Clause
// Squared distances to obstacles on a grid of cells that may change.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "geometry/types.hpp"

namespace photonav {

/// Capped exact squared Euclidean distance between the centres of cells, computed one axis after
/// the other (the lower envelopes of Felzenszwalb and Huttenlocher, Distance Transforms of Sampled
/// Functions, 2012). The result of every axis is stored: an update recomputes only cells within
/// `reach` of a changed obstacle, and passes on to the next axis only the cells that have changed.
///
/// Obstacles are set on the `outer` cells: the inner cells and `reach` more cells on every side.
/// Distances are computed for the inner cells. At first there are no obstacles.
class DistanceTransform {
  public:
    static constexpr int kBlock = 32;  ///< cells along x that are computed together

    DistanceTransform() = default;
    /// @param reach [cells], at most 180: distances are capped at this
    DistanceTransform(const Eigen::Array3i& inner, int reach);

    /// Memory that a transform takes [bytes].
    static double bytes(const Eigen::Array3d& inner, double reach);

    bool empty() const { return column_.empty(); }
    Eigen::Array3i outer() const { return inner_ + 2 * reach_; }

    /// Makes the outer cells of a box, as far as they exist, obstacles or free.
    void set(const Eigen::Array3i& first, const Eigen::Array3i& last, bool isObstacle);

    /// The same for each of 4 x 4 x 4 cells, x fastest.
    void setBlock(const Eigen::Array3i& first, const std::array<bool, 64>& isObstacle);

    /// Squared distances of inner cells (x ... x + n - 1, y, z).
    using Visit =
        std::function<void(int x, int y, int z, int n, const std::uint16_t* squaredDistances)>;

    /// Updates the distances after calls of set().
    /// @param visit called for all cells whose squared distance changed, and for some that did not
    ///        change; distances begin at reach^2
    void update(const Visit& visit);

  private:
    struct Range {  // of y; empty unless low <= high
        int low = 1, high = 0;
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

    std::vector<Range> changedCells_;          // z fastest, then block
    std::vector<std::uint8_t> changedColumn_;  // z (outer) fastest, then block, then y (inner)
    std::vector<std::uint8_t> changedPlane_;   // block fastest, then z (inner), then y (inner)
    std::vector<std::uint8_t> todo_;           // of one line
    std::vector<std::uint16_t> squares_;       // of one block in x, outer z
};

}  // namespace photonav
