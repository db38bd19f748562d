// SPDX-License-Identifier: BSD-3-Clause
#include "map/brick_tree.hpp"

#include <algorithm>

namespace photonav {

BrickTree::BrickTree(const MapChange& change, const std::vector<Eigen::Array3i>& bricks,
                     double margin) {
    Boxes boxes;
    const Eigen::Vector3d grown = Eigen::Vector3d::Constant(margin);
    for (const auto& brick : bricks) {
        const Eigen::AlignedBox3d box = change.boxOf(brick);
        boxes.emplace_back(box.min() - grown, box.max() + grown);
    }
    if (!boxes.empty()) build(boxes.begin(), boxes.end());
}

void BrickTree::build(Boxes::iterator begin, Boxes::iterator end) {
    Eigen::AlignedBox3d around;
    for (auto it = begin; it != end; ++it) around.extend(*it);
    const std::size_t self = nodes_.size();
    nodes_.push_back({around, 0});
    if (end - begin > 1) {
        int axis = 0;
        around.sizes().maxCoeff(&axis);
        const auto middle = begin + (end - begin) / 2;
        std::nth_element(begin, middle, end, [axis](const auto& a, const auto& b) {
            return a.min()[axis] < b.min()[axis];
        });
        build(begin, middle);
        build(middle, end);
    }
    nodes_[self].end = nodes_.size();
}

}  // namespace photonav
