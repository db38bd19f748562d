// SPDX-License-Identifier: BSD-3-Clause
// Where a map may be out of date.
#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include "geometry/camera.hpp"
#include "geometry/types.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// A new obstacle that an image shows may go on beyond the image, or behind what is in view. Until
/// they are seen again, nothing is known of the columns of cells around it that the image does not
/// show.
class DoubtedColumns {
  public:
    /// @param cell edge [m]
    /// @param height below the camera at which a column is looked for [m]
    DoubtedColumns(double cell, double height) : cell_(cell), height_(height) {}

    /// @param places on new obstacles; of a column one is enough
    void doubtAround(const std::vector<Eigen::Vector3d>& places);
    /// A column is no longer doubted once a depth image shows free space or a surface in it.
    void look(const ImageF& depth, const Camera& camera, const Pose& T_c_w);

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
