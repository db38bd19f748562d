// SPDX-License-Identifier: BSD-3-Clause
// A room of 8 x 4 m, and a flight to its other end.
#pragma once

#include <optional>

#include "config/config.hpp"
#include "scene/scene.hpp"
#include "scene/texture.hpp"

namespace photonav {

/// With textured floor and walls, and perhaps a box.
inline Scene longRoom(double height, const std::optional<Eigen::AlignedBox3d>& box) {
    Scene scene;
    const auto floor = addTexture(scene, valueNoise({.size = {8., 4.}, .seed = 1}));
    const auto walls = addTexture(scene, valueNoise({.size = {8., 3.}, .seed = 2}));
    addBox(scene, {0., 0., 0.}, {8., 4., height}, walls, BoxInside::hollow);
    addPlane(scene, {0., 0., 0.01}, {8., 0., 0.}, {0., 4., 0.}, floor);
    if (box) addBox(scene, box->min(), box->max(), walls);
    return scene;
}

/// Any heading.
/// @param mount of the camera, see CameraConfig
inline Config flightThroughLongRoom(const std::string& mount) {
    Config config;
    config.bounds = {Eigen::Vector3d(0.4, 0.4, 0.8), Eigen::Vector3d(7.6, 3.6, 1.4)};
    config.start.position = {1., 2., 1.1};
    config.start.yaw = 0.;
    config.goal.position = {7., 2., 1.1};
    config.space = StateKind::positionYaw;
    config.camera.mount = mount;
    config.camera.width = 94;
    config.camera.height = 60;
    config.photometric.scale = 1.;  // a grey camera: the noise of its pixels is independent
    return config;
}

}  // namespace photonav
