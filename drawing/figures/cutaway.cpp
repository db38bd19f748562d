// SPDX-License-Identifier: BSD-3-Clause
#include "figures/cutaway.hpp"

#include <array>
#include <vector>

#include "render/mesh_renderer.hpp"
#include "render/voxel_renderer.hpp"

namespace photonav {
namespace {

constexpr double kFloorThickness = 0.05;  // the floor ends so far above the lowest surface [m]
constexpr double kSectionGrey = 0.2;

using Corner = Eigen::Matrix<float, 5, 1>;  // x, y, z, u, v
using Polygon = std::vector<Corner>;

/// The points whose coordinate along an axis is at least (sign 1) or at most (sign -1) a limit.
struct HalfSpace {
    int axis = 0;
    float sign = 1.F;
    float limit = 0.F;

    float distance(const Corner& corner) const { return sign * (corner[axis] - limit); }
};

using Part = std::vector<HalfSpace>;  // of space: the intersection of half-spaces

/// The part of a convex polygon in a half-space.
Polygon clipped(const Polygon& polygon, const HalfSpace& space) {
    Polygon result;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const float da = space.distance(a), db = space.distance(b);
        if (da >= 0.F) result.push_back(a);
        if (da * db < 0.F) result.emplace_back(a + da / (da - db) * (b - a));
    }
    return result;
}

/// Adds the part of a triangle in a part of space.
void addClipped(Scene& scene, const Triangle& triangle, const Part& part) {
    Polygon polygon;
    for (std::size_t i = 0; i < 3; ++i)
        polygon.emplace_back() << triangle.corners[i], triangle.uv[i];
    for (const HalfSpace& space : part) polygon = clipped(polygon, space);
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        Triangle piece{.corners = {}, .texture = triangle.texture};
        const std::array corners{polygon[0], polygon[i - 1], polygon[i]};
        for (std::size_t k = 0; k < 3; ++k) {
            piece.corners[k] = corners[k].head<3>();
            piece.uv[k] = corners[k].tail<2>();
        }
        const Eigen::Vector3f a = piece.corners[1] - piece.corners[0];
        if (a.cross(piece.corners[2] - piece.corners[0]).norm() > 0.F)
            scene.triangles.push_back(piece);
    }
}

/// The cross sections of solids at a height.
std::vector<Triangle> sections(const Scene& scene, double height, std::uint32_t texture) {
    std::vector<Triangle> triangles;
    for (const Prism& solid : scene.solids) {
        if (solid.low >= height || solid.high <= height) continue;
        const auto corner = [&](std::size_t i) -> Eigen::Vector3f {
            return Eigen::Vector3d(solid.footprint[i].x(), solid.footprint[i].y(), height)
                .cast<float>();
        };
        for (std::size_t i = 2; i < solid.footprint.size(); ++i)
            triangles.push_back(
                {.corners = {corner(0), corner(i - 1), corner(i)}, .texture = texture});
    }
    return triangles;
}

Scene cutOpen(const Scene& scene, const Eigen::AlignedBox3d& inside, double floor) {
    const Eigen::Vector3f low = inside.min().cast<float>(), high = inside.max().cast<float>();
    const HalfSpace belowTop{2, -1.F, high.z()};
    const auto top = static_cast<float>(floor);
    const std::array<Part, 2> kept{
        Part{belowTop, {2, -1.F, top}},
        Part{belowTop, {2, 1.F, top}, {0, 1.F, low.x()}, {1, 1.F, low.y()}}};
    Scene result;
    result.textures = scene.textures;
    const std::uint32_t dark = addTexture(result, uniformTexture(kSectionGrey));
    for (const Part& part : kept) {
        for (const Triangle& triangle : scene.triangles) addClipped(result, triangle, part);
        for (const Triangle& triangle : sections(scene, inside.max().z(), dark))
            addClipped(result, triangle, part);
    }
    return result;
}

TexturedOcTree cutOpen(const TexturedOcTree& map, const Eigen::AlignedBox3d& inside, double floor) {
    TexturedOcTree result(map);
    for (auto cell = result.begin_leafs(); cell != result.end_leafs(); ++cell) {
        const bool isBeyond = cell.getX() < inside.min().x() || cell.getY() < inside.min().y();
        if (cell.getZ() > inside.max().z() || (isBeyond && cell.getZ() > floor))
            cell->setLogOdds(result.getClampingThresMinLog());
    }
    return result;
}

}  // namespace

std::unique_ptr<ViewSource> cutawayViews(const World& world, const Eigen::AlignedBox3d& inside) {
    const double floor = world.extent().min().z() + kFloorThickness;
    if (const Scene* scene = world.scene())
        return std::make_unique<MeshRenderer>(cutOpen(*scene, inside, floor));
    const TexturedOcTree& map = *world.map();
    return std::make_unique<VoxelRenderer>(cutOpen(map, inside, floor + map.getResolution()),
                                           UnknownPolicy::free);
}

}  // namespace photonav
