// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/known_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/error.hpp"
#include "map/brick_leaves.hpp"
#include "problem/map_of_config.hpp"

namespace photonav {
namespace {

constexpr double kMostCells = 2147483648.;  // of a map's bounding box, as in views

void check(const TexturedOcTree& map, const Config& config) {
    const auto refuse = [&](const std::string& reason) {
        throw config.invalid("map.file", config.mapFile + ": " + reason);
    };
    if (map.size() == 0) refuse("is empty");
    const double cell = map.getResolution();
    if (cell < kLeastExploreCell || cell > kMostExploreCell) {
        refuse(fmt::format("has cells of {} m, an exploration may have {} to {} m", cell,
                           kLeastExploreCell, kMostExploreCell));
    }
    const std::optional<double>& wanted = config.explore.resolution;
    if (wanted && std::abs(cell / *wanted - 1.) > 1e-6) {
        refuse(fmt::format(
            "has cells of {} m, explore.resolution is {} m: give the same, or leave it out", cell,
            *wanted));
    }
    Eigen::AlignedBox3d box;
    map.getMetricMin(box.min().x(), box.min().y(), box.min().z());
    map.getMetricMax(box.max().x(), box.max().y(), box.max().z());
    if ((box.sizes() / cell).prod() > kMostCells) refuse("is too large for views");
    const Eigen::Vector3d range = Eigen::Vector3d::Constant(config.explore.range);
    const Eigen::AlignedBox3d inView(config.bounds.min() - range, config.bounds.max() + range);
    if (!inView.intersects(box)) {
        refuse(
            fmt::format("reaches from ({:.1f}, {:.1f}, {:.1f}) to ({:.1f}, {:.1f}, {:.1f}) m: "
                        "nothing of it is within explore.range of the bounds",
                        box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(),
                        box.max().z()));
    }
}

}  // namespace

World trueWorld(Config config) {
    if (knowsMap(config)) config.mapFile = config.mapMadeBy = "";
    return World(config);
}

std::shared_ptr<const TexturedOcTree> loadKnownMap(const Config& config) {
    if (!knowsMap(config)) return nullptr;
    std::shared_ptr<const TexturedOcTree> map = loadMapOf(config);
    check(*map, config);
    return map;
}

std::vector<Eigen::Array3i> bricksWith(
    const TexturedOcTree& map, const std::function<bool(const TexturedOcTreeNode& leaf)>& holds) {
    MapChange found;
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        if (!holds(*leaf)) continue;
        const int cells = 1 << (map.getTreeDepth() - leaf.getDepth());
        const int edge = std::max(1, cells / MapChange::kBrickEdge);
        visitCells(brickOf(leaf.getIndexKey()), edge,
                   [&](int x, int y, int z) { found.occupancy.emplace_back(x, y, z); });
    }
    found.normalize();
    return found.occupancy;
}

}  // namespace photonav
