// SPDX-License-Identifier: BSD-3-Clause
// Finds the bricks of a change that are near something.
#pragma once

#include <vector>

#include "map/map_change.hpp"

namespace photonav {

/// Boxes around bricks of a change, as a tree of boxes.
class BrickTree {
  public:
    /// @param bricks some of the bricks of the change
    /// @param margin by which the box of each brick is grown to every side [m]
    BrickTree(const MapChange& change, const std::vector<Eigen::Array3i>& bricks, double margin);

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
