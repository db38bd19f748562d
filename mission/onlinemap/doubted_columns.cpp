// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/doubted_columns.hpp"

#include <cmath>

#include "onlinemap/obstacles_in_view.hpp"

namespace photonav {
namespace {

constexpr double kAround = 1.;    // [m]
constexpr int kOrigin = 1 << 30;  // makes indices positive

}  // namespace

DoubtedColumns::Column DoubtedColumns::columnOf(double x, double y) const {
    const auto index = [this](double value) {
        return static_cast<Column>(static_cast<int>(std::floor(value / cell_)) + kOrigin);
    };
    return index(x) << 32U | index(y);
}

Eigen::Vector2d DoubtedColumns::middleOf(Column column) const {
    const auto coordinate = [this](Column index) {
        return cell_ * (static_cast<double>(index) - kOrigin + 0.5);
    };
    return {coordinate(column >> 32U), coordinate(column & 0xffffffffU)};
}

void DoubtedColumns::doubtAround(const std::vector<Eigen::Vector3d>& places) {
    const int reach = static_cast<int>(kAround / cell_);
    std::unordered_set<Column> obstacles;
    for (const Eigen::Vector3d& p_w : places) obstacles.insert(columnOf(p_w.x(), p_w.y()));
    for (const Column obstacle : obstacles) {
        const Eigen::Vector2d middle = middleOf(obstacle);
        for (int y = -reach; y <= reach; ++y) {
            for (int x = -reach; x <= reach; ++x) {
                if (x * x + y * y > reach * reach) continue;
                columns_.insert(columnOf(middle.x() + cell_ * x, middle.y() + cell_ * y));
            }
        }
    }
}

void DoubtedColumns::look(const ImageF& depth, const Camera& camera, const Pose& T_c_w) {
    const double top = T_c_w.inverse().translation().z();
    std::erase_if(columns_, [&](Column column) {
        const Eigen::Vector2d middle = middleOf(column);
        for (double below = 0.; below <= height_; below += 2. * cell_) {
            const Eigen::Vector3d p_w(middle.x(), middle.y(), top - below);
            // Free space, or a surface.
            if (isSeenThrough(p_w, depth, camera, T_c_w, -2. * cell_)) return true;
        }
        return false;
    });
}

}  // namespace photonav
