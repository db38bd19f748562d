// SPDX-License-Identifier: BSD-3-Clause
// A coarse bound of the space that a view depends on, to test whether a change of the map affects
// the view.
#pragma once

#include <vector>

#include "geometry/camera.hpp"
#include "map/map_change.hpp"

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

/// The bricks of a change, each grown to the space from which it can change a view, as a tree of
/// boxes.
///
/// A view depends on the cells along its rays and on the cells around the ends of its rays: grey
/// values are interpolated between neighbouring faces, also across steps and borders of the
/// surface.
class ChangedBricks {
  public:
    /// Distance from the end of a ray within which cells affect its grey value (VoxelRenderer)
    /// [cells].
    static constexpr int kReach = 2;

    /// The bricks MapChange::occupancy and MapChange::texture, grown by kReach.
    explicit ChangedBricks(const MapChange& change);

    /// Whether `meets(box)` is true for the box of any brick (world frame [m]). `meets` is first
    /// called for boxes around several bricks: if it is true for a box, it must also be true for
    /// every box that contains this box.
    template <class Predicate>
    bool any(const Predicate& meets) const {
        for (std::size_t i = 0; i < nodes_.size();) {
            const Node& node = nodes_[i];
            const bool isMet = meets(node.box);
            if (isMet && node.end == i + 1) return true;
            i = isMet ? i + 1 : node.end;
        }
        return false;
    }

  private:
    struct Node {
        Eigen::AlignedBox3d box;
        std::size_t end;  // of the nodes below this one, which follow it; a leaf has none
    };
    using Boxes = std::vector<Eigen::AlignedBox3d>;

    void build(Boxes::iterator begin, Boxes::iterator end);

    std::vector<Node> nodes_;
};

}  // namespace photonav
