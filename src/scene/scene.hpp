// SPDX-License-Identifier: BSD-3-Clause
// A scene of textured triangles, from a mesh file or a procedural description.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/texture.hpp"

namespace photonav {

/// A triangle. Both sides are visible.
struct Triangle {
    std::array<Eigen::Vector3f, 3> corners;  ///< world frame [m]
    std::array<Eigen::Vector2f, 3> uv{Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero(),
                                      Eigen::Vector2f::Zero()};
    std::uint32_t texture = 0;  ///< index into Scene::textures
};

/// An upright solid prism.
struct Prism {
    std::vector<Eigen::Vector2d> footprint;  ///< convex, x-y [m]
    double low = 0., high = 0.;              ///< z [m]
};

struct Scene {
    std::vector<Texture> textures;
    std::vector<Triangle> triangles;
    /// The inside of solid boxes and walls, which is an obstacle away from surfaces as well. (The
    /// inside of a mesh from a file counts as free.)
    std::vector<Prism> solids;
    std::vector<std::string> files;  ///< files that were read: scene or mesh, textures, materials

    Eigen::AlignedBox3d boundingBox() const;  ///< of the triangles, world frame [m]
    /// Adds the content of another scene.
    void append(const Scene& other);
};

/// Reads .yaml and .yml as a procedural scene (scene_yaml.hpp), anything else as a mesh
/// (mesh_io.hpp). @throws InputError
Scene loadScene(const std::string& file);

/// Adds a texture and returns its index, which surfaces refer to.
std::uint32_t addTexture(Scene& scene, Texture texture);

/// Largest distance of a surface from the origin along an axis [m]. Single precision resolves
/// centimetres at this distance.
inline constexpr double kFarthestSurface = 1e5;

/// Adds a parallelogram with corners corner, corner + u, corner + u + v and corner + v, world frame
/// [m]. Texture coordinates run along u and across it, toward v, in metres from the corner. Seen
/// from the side where u points right and v points down, an image is upright.
/// @param texture index from addTexture()
/// @param offset texture position at the corner [m]
/// @throws std::invalid_argument for a surface without area or beyond kFarthestSurface
void addPlane(Scene& scene, const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
              const Eigen::Vector3d& v, std::uint32_t texture,
              const Eigen::Vector2d& offset = Eigen::Vector2d::Zero());

/// Whether a box is solid, or hollow like a room.
enum class BoxInside { solid, hollow };
/// Adds the six faces of an axis-aligned box, world frame [m].
/// @throws std::invalid_argument unless `max` is beyond `min` along every axis
void addBox(Scene& scene, const Eigen::Vector3d& min, const Eigen::Vector3d& max,
            std::uint32_t texture, BoxInside inside = BoxInside::solid);

/// An upright wall along a polyline on the ground, joints mitred.
struct Wall {
    std::vector<Eigen::Vector2d> footprint;  ///< centre line, x-y [m], at least two points
    double height = 2.5;                     ///< [m]
    double thickness = 0.1;                  ///< [m]
    double bottom = 0.;                      ///< z of its foot [m]
    bool closed = false;                     ///< whether the last point is joined to the first
};
/// Adds the surfaces of a wall and its inside as solids.
/// @throws std::invalid_argument for too few points, a footprint that turns back on itself, and a
///        height or thickness that is not positive
void addWall(Scene& scene, const Wall& wall, std::uint32_t texture);

}  // namespace photonav
