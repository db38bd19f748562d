// SPDX-License-Identifier: BSD-3-Clause
// Scenes and poses that the benchmarks of tracking share.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "geometry/camera.hpp"
#include "render/mesh_renderer.hpp"
#include "scene/scene.hpp"

namespace photonav {

inline Camera trackingCamera(unsigned width = 188) {
    return makeCamera(width, width * 120 / 188, 70. * std::numbers::pi / 180.);
}

/// A hall of 8 x 8 x 3 m with textured floor and walls and twelve boxes.
/// @param moved distance by which the boxes stand elsewhere, along x [m]
/// @param contrast contrast of floor and walls relative to the boxes
inline Scene furnishedHall(double moved = 0., double contrast = 1.) {
    Scene scene;
    const std::vector<double> amplitudes(3, contrast * 0.4 / 3.);
    const auto floor =
        addTexture(scene, valueNoise({.size = {8., 8.}, .amplitudes = amplitudes, .seed = 1}));
    const auto walls =
        addTexture(scene, valueNoise({.size = {4., 3.}, .amplitudes = amplitudes, .seed = 2}));
    const auto crates = addTexture(scene, valueNoise({.size = {1., 1.}, .seed = 3}));
    addBox(scene, {0., 0., 0.}, {8., 8., 3.}, walls, BoxInside::hollow);
    addPlane(scene, {0., 0., 0.01}, {8., 0., 0.}, {0., 8., 0.}, floor);
    for (int i = 0; i < 12; ++i) {
        const Eigen::Vector3d corner(1. + 0.5 * i + moved, 1. + 1.7 * (i * 5 % 4), 0.);
        addBox(scene, corner, corner + Eigen::Vector3d(0.4, 0.4, 0.5), crates);
    }
    return scene;
}

/// Nothing but a textured floor.
inline Scene texturedFloor() {
    Scene scene;
    const auto floor = addTexture(scene, valueNoise({.size = {8., 8.}, .seed = 1}));
    addPlane(scene, {-12., -12., 0.}, {32., 0., 0.}, {0., 32., 0.}, floor);
    return scene;
}

/// On a circle of 2 m radius about the hall's centre, 1.7 m high, looking ahead and inward.
inline Pose onCircle(double angle, double belowHorizon) {
    return lookFrom({4. + 2. * std::cos(angle), 4. + 2. * std::sin(angle), 1.7}, belowHorizon,
                    angle + 2.);
}

/// Calls compare(name, world, angle of the view below the horizon) for a floor, and for a hall seen
/// from two angles.
inline void forTrackingViews(const auto& compare) {
    const MeshRenderer hall(furnishedHall()), floor(texturedFloor());
    compare("textured floor, downward from 1.7 m", floor, std::numbers::pi / 2.);
    compare("hall with boxes, 45 degrees", hall, std::numbers::pi / 4.);
    compare("hall with boxes, 10 degrees below the horizon", hall, std::numbers::pi / 18.);
}

}  // namespace photonav
