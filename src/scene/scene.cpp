// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scene.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "io/reading.hpp"
#include "scene/mesh_io.hpp"
#include "scene/scene_yaml.hpp"

namespace photonav {
namespace {

/// The two long edges of a wall: the centre line moved sideways by half the thickness, with the
/// offset lines intersected at every joint.
struct WallSides {
    std::vector<Eigen::Vector2d> left, right;
};

Eigen::Vector2d leftNormal(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    const Eigen::Vector2d direction = (to - from).normalized();
    return {-direction.y(), direction.x()};
}

WallSides wallSides(const Wall& wall) {
    const auto& points = wall.footprint;
    const std::size_t n = points.size();
    WallSides sides;
    for (std::size_t i = 0; i < n; ++i) {
        const bool first = i == 0 && !wall.closed;
        const bool last = i + 1 == n && !wall.closed;
        const Eigen::Vector2d& before = points[(i + n - 1) % n];
        const Eigen::Vector2d& after = points[(i + 1) % n];
        const Eigen::Vector2d in =
            leftNormal(first ? points[i] : before, first ? after : points[i]);
        const Eigen::Vector2d out = last ? in : leftNormal(points[i], after);
        const double cosine = 1. + in.dot(out);
        if (!(cosine > 0.1)) throw std::invalid_argument("wall: footprint turns back on itself");
        const Eigen::Vector2d shift = (0.5 * wall.thickness / cosine) * (in + out);
        sides.left.emplace_back(points[i] + shift);
        sides.right.emplace_back(points[i] - shift);
    }
    return sides;
}

/// A convex planar quadrilateral a b c d; the texture runs in metres along a-b and across it.
void addQuad(Scene& scene, const std::array<Eigen::Vector3d, 4>& corners, std::uint32_t texture,
             const Eigen::Vector2d& offset) {
    if (texture >= scene.textures.size()) throw std::invalid_argument("scene: no such texture");
    for (const Eigen::Vector3d& corner : corners) {
        if (!(corner.array().abs() <= kFarthestSurface).all()) {
            throw std::invalid_argument(fmt::format(
                "scene: surface farther than {:g} m from the origin", kFarthestSurface));
        }
    }
    if (!(offset.array().abs() <= kFarthestSurface).all()) {
        throw std::invalid_argument(
            fmt::format("scene: texture offset beyond {:g} m", kFarthestSurface));
    }
    const Eigen::Vector3d u = (corners[1] - corners[0]).normalized();
    const Eigen::Vector3d across = corners[3] - corners[0];
    const Eigen::Vector3d v = (across - across.dot(u) * u).normalized();
    if (!(u.squaredNorm() > 0.5 && v.squaredNorm() > 0.5)) {
        throw std::invalid_argument("scene: surface without area");
    }
    const Eigen::Vector2d& size = scene.textures[texture].size;
    const auto uv = [&](int i) -> Eigen::Vector2f {
        const Eigen::Vector3d p = corners[i] - corners[0];
        const Eigen::Vector2d metres = offset + Eigen::Vector2d(p.dot(u), p.dot(v));
        return metres.cwiseQuotient(size).cast<float>();
    };
    const auto corner = [&](int i) -> Eigen::Vector3f { return corners[i].cast<float>(); };
    scene.triangles.push_back({{corner(0), corner(1), corner(2)}, {uv(0), uv(1), uv(2)}, texture});
    scene.triangles.push_back({{corner(0), corner(2), corner(3)}, {uv(0), uv(2), uv(3)}, texture});
}

Eigen::Vector3d lifted(const Eigen::Vector2d& p, double z) { return {p.x(), p.y(), z}; }

}  // namespace

Eigen::AlignedBox3d Scene::boundingBox() const {
    Eigen::AlignedBox3d box;
    for (const Triangle& triangle : triangles) {
        for (const auto& corner : triangle.corners) box.extend(corner.cast<double>());
    }
    return box;
}

void Scene::append(const Scene& other) {
    const auto before = static_cast<std::uint32_t>(textures.size());
    const auto add = [](auto& list, const auto& more) {
        list.insert(list.end(), more.begin(), more.end());
    };
    add(textures, other.textures);
    add(solids, other.solids);
    add(files, other.files);
    for (Triangle triangle : other.triangles) {
        triangle.texture += before;
        triangles.push_back(triangle);
    }
}

Scene loadScene(const std::string& file) {
    return reading(file, [&] {
        const auto extension = std::filesystem::path(file).extension();
        return extension == ".yaml" || extension == ".yml" ? loadSceneYaml(file) : loadMesh(file);
    });
}

std::uint32_t addTexture(Scene& scene, Texture texture) {
    scene.textures.push_back(std::move(texture));
    return static_cast<std::uint32_t>(scene.textures.size() - 1);
}

void addPlane(Scene& scene, const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
              const Eigen::Vector3d& v, std::uint32_t texture, const Eigen::Vector2d& offset) {
    addQuad(scene, {corner, corner + u, corner + u + v, corner + v}, texture, offset);
}

void addBox(Scene& scene, const Eigen::Vector3d& min, const Eigen::Vector3d& max,
            std::uint32_t texture, BoxInside inside) {
    const Eigen::Vector3d size = max - min;
    if (!(size.minCoeff() > 0.)) throw std::invalid_argument("box: max must be beyond min");
    const Eigen::Vector3d x(size.x(), 0., 0.);
    const Eigen::Vector3d y(0., size.y(), 0.);
    const Eigen::Vector3d z(0., 0., size.z());
    addPlane(scene, min + y + z, x, -y, texture);   // top
    addPlane(scene, min, x, y, texture);            // bottom
    addPlane(scene, min + z, x, -z, texture);       // towards -y
    addPlane(scene, max, -x, -z, texture);          // towards +y
    addPlane(scene, min + y + z, -y, -z, texture);  // towards -x
    addPlane(scene, min + x + z, y, -z, texture);   // towards +x
    if (inside == BoxInside::hollow) return;
    const Eigen::Vector2d low = min.head<2>(), high = max.head<2>();
    scene.solids.push_back(
        {{low, {high.x(), low.y()}, high, {low.x(), high.y()}}, min.z(), max.z()});
}

void addWall(Scene& scene, const Wall& wall, std::uint32_t texture) {
    const std::size_t n = wall.footprint.size();
    if (n < (wall.closed ? 3 : 2)) throw std::invalid_argument("wall: too few footprint points");
    if (!(wall.height > 0. && wall.thickness > 0.)) {
        throw std::invalid_argument("wall: height and thickness must be positive");
    }
    const auto [left, right] = wallSides(wall);
    const double low = wall.bottom;
    const double high = wall.bottom + wall.height;
    const auto upright = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b, double along) {
        addQuad(scene, {lifted(a, high), lifted(b, high), lifted(b, low), lifted(a, low)}, texture,
                {along, 0.});
    };
    double along = 0.;
    for (std::size_t i = 0; i + (wall.closed ? 0 : 1) < n; ++i) {
        const std::size_t j = (i + 1) % n;
        upright(right[i], right[j], along);
        upright(left[j], left[i], along);
        for (const double z : {low, high}) {
            addQuad(
                scene,
                {lifted(right[i], z), lifted(right[j], z), lifted(left[j], z), lifted(left[i], z)},
                texture, {along, 0.});
        }
        scene.solids.push_back({{right[i], right[j], left[j], left[i]}, low, high});
        along += (wall.footprint[j] - wall.footprint[i]).norm();
    }
    if (wall.closed) return;
    upright(left.front(), right.front(), 0.);
    upright(right.back(), left.back(), 0.);
}

}  // namespace photonav
