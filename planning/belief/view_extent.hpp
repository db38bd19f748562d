// SPDX-License-Identifier: BSD-3-Clause
// A coarse bound of the space that a view depends on, to test whether a change of the map affects
// the view.
#pragma once

#include <vector>

#include "geometry/camera.hpp"
#include "geometry/types.hpp"

namespace photonav {

/// The space between a camera and the surfaces in its view, stored as the largest depth of the
/// pixels of each tile of the image. Pixels without depth (no surface, or unknown space) count as
/// unbounded.
class ViewExtent {
  public:
    static constexpr unsigned kTile = 8;  ///< edge of a tile [px]

    ViewExtent() = default;
    /// @param depth z of the surface in the camera frame [m]; 0: no surface, or unknown space
    ViewExtent(const Camera& camera, const ImageF& depth);

    /// Whether a ray of the view intersects the box before it ends. Conservative: may be true for a
    /// box that no ray intersects, but is never false for one that a ray intersects.
    /// @param T_c_w camera pose of the view
    /// @param box_w box in the world frame [m]
    bool meets(const Camera& camera, const Pose& T_c_w, const Eigen::AlignedBox3d& box_w) const;

    /// A box in the world frame that contains the whole extent [m].
    Eigen::AlignedBox3d bounds(const Camera& camera, const Pose& T_c_w) const;

  private:
    unsigned columns_ = 0, rows_ = 0;
    std::vector<float> depth_;  // by tile, row by row
};

}  // namespace photonav
