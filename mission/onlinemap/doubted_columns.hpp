// SPDX-License-Identifier: BSD-3-Clause
// Columns of a map that may be out of date.
#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include "geometry/camera.hpp"
#include "geometry/types.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// A new obstacle that appears in an image may extend beyond the image, or behind other surfaces.
/// The columns of cells within 1 m of it therefore count as unobserved until a depth image shows
/// them again.
class DoubtedColumns {
  public:
    /// @param cell edge of a cell [m]
    /// @param height a column is checked by look() from the camera's height down to this distance
    ///        below it [m]
    DoubtedColumns(double cell, double height) : cell_(cell), height_(height) {}

    /// Marks the columns around new obstacles as doubted.
    /// @param places points on new obstacles, world frame [m]; one per column is enough
    void doubtAround(const std::vector<Eigen::Vector3d>& places);
    /// Removes the doubt from all columns in which a depth image shows free space or a surface.
    void look(const ImageF& depth, const Camera& camera, const Pose& T_c_w);

    /// Whether the column of a place is doubted.
    bool contains(const Eigen::Vector3d& p_w) const {
        return !columns_.empty() && columns_.contains(columnOf(p_w.x(), p_w.y()));
    }

  private:
    using Column = std::uint64_t;
    Column columnOf(double x, double y) const;
    Eigen::Vector2d middleOf(Column column) const;

    double cell_, height_;
    std::unordered_set<Column> columns_;
};

}  // namespace photonav
