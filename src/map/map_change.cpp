// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_change.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <tuple>

namespace photonav {
namespace {

using Bricks = std::vector<Eigen::Array3i>;

bool isBefore(const Eigen::Array3i& a, const Eigen::Array3i& b) {
    return std::tuple(a.z(), a.y(), a.x()) < std::tuple(b.z(), b.y(), b.x());
}

Bricks unite(const Bricks& a, const Bricks& b) {
    Bricks both;
    both.reserve(a.size() + b.size());
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both), isBefore);
    return both;
}

void makeSet(Bricks& bricks) {
    std::sort(bricks.begin(), bricks.end(), isBefore);
    const auto same = [](const auto& a, const auto& b) { return (a == b).all(); };
    bricks.erase(std::unique(bricks.begin(), bricks.end(), same), bricks.end());
}

void extend(Eigen::AlignedBox3d& box, const MapChange& change, const Bricks& bricks) {
    for (const auto& brick : bricks) box.extend(change.boxOf(brick));
}

}  // namespace

void MapChange::join(const MapChange& other) {
    if (other.empty()) return;
    if (!empty() && resolution != other.resolution) {
        throw std::invalid_argument("MapChange: the maps differ in resolution");
    }
    resolution = other.resolution;
    occupancy = unite(occupancy, other.occupancy);
    texture = unite(texture, other.texture);
    anyTexture = unite(anyTexture, other.anyTexture);
}

void MapChange::normalize() {
    makeSet(occupancy);
    makeSet(texture);
    makeSet(anyTexture);
}

Bricks MapChange::bricks() const { return unite(occupancy, unite(texture, anyTexture)); }

Eigen::AlignedBox3d MapChange::box() const {
    Eigen::AlignedBox3d box;
    extend(box, *this, occupancy);
    extend(box, *this, texture);
    extend(box, *this, anyTexture);
    return box;
}

Eigen::AlignedBox3d MapChange::boxOf(const Eigen::Array3i& brick) const {
    const double edge = kBrickEdge * resolution;
    return {edge * brick.cast<double>().matrix(), edge * (brick + 1).cast<double>().matrix()};
}

}  // namespace photonav
