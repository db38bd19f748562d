// SPDX-License-Identifier: BSD-3-Clause
// A textured triangle scene: what a mesh file or a procedural description becomes.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/texture.hpp"

namespace photonav {

/// A triangle with its own corners: world frame, metres. Both sides are visible.
struct Triangle {
    std::array<Eigen::Vector3f, 3> corners;
    std::array<Eigen::Vector2f, 3> uv{Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero(),
                                      Eigen::Vector2f::Zero()};
    std::uint32_t texture = 0;  ///< index into Scene::textures
};

/// An upright prism full of matter.
struct Prism {
    std::vector<Eigen::Vector2d> footprint;  ///< convex, x-y [m]
    double low = 0., high = 0.;              ///< z [m]
};

struct Scene {
    std::vector<Texture> textures;
    std::vector<Triangle> triangles;
    /// Where there is no room although no surface is near: the inside of boxes and walls. (Of a
    /// mesh only surfaces are known; its inside counts as free.)
    std::vector<Prism> solids;
    std::vector<std::string> files;  ///< that were read for it: scene or mesh, textures, materials

    Eigen::AlignedBox3d boundingBox() const;
    /// Adds all that another scene has.
    void append(const Scene& other);
};

/// Reads .yaml and .yml as a procedural scene (scene_yaml.hpp), anything else as a mesh
/// (mesh_io.hpp). @throws InputError
Scene loadScene(const std::string& file);

/// Adds a texture and returns its index, which surfaces refer to.
std::uint32_t addTexture(Scene& scene, Texture texture);

/// The farthest that a surface may be from the origin along an axis [m]; single precision tells
/// centimetres apart there.
inline constexpr double kFarthestSurface = 1e5;

/// A parallelogram with corner, corner + u, corner + v. Texture coordinates run along u and v in
/// metres from the corner; seen from where u points right and v points down an image is upright.
/// @param offset texture position at the corner [m]
/// @throws std::invalid_argument for a surface without area or beyond kFarthestSurface
void addPlane(Scene& scene, const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
              const Eigen::Vector3d& v, std::uint32_t texture,
              const Eigen::Vector2d& offset = Eigen::Vector2d::Zero());

/// The six faces of an axis-aligned box, which is full inside, or hollow as a room is.
enum class BoxInside { solid, hollow };
void addBox(Scene& scene, const Eigen::Vector3d& min, const Eigen::Vector3d& max,
            std::uint32_t texture, BoxInside inside = BoxInside::solid);

/// An upright wall along a polyline on the ground, joints mitred.
struct Wall {
    std::vector<Eigen::Vector2d> footprint;  ///< centre line, x-y [m], at least two points
    double height = 2.5;                     ///< [m]
    double thickness = 0.1;                  ///< [m]
    double bottom = 0.;                      ///< z of its foot [m]
    bool closed = false;                     ///< the last point is joined to the first
};
void addWall(Scene& scene, const Wall& wall, std::uint32_t texture);

}  // namespace photonav
