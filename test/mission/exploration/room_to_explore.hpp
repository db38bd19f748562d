// SPDX-License-Identifier: BSD-3-Clause
// A room that a robot does not know, and a flight through it.
#pragma once

#include "config/config.hpp"
#include "scene/scene.hpp"

namespace photonav::test {

/// A room of 8 x 4 x 3 m; a box as high as the room stands between start and goal.
inline Scene roomToExplore() {
    Scene scene;
    const auto floor = addTexture(scene, valueNoise({.size = {8., 4.}, .seed = 1}));
    const auto walls = addTexture(scene, valueNoise({.size = {8., 3.}, .seed = 2}));
    addBox(scene, {0., 0., 0.}, {8., 4., 3.}, walls, BoxInside::hollow);
    addPlane(scene, {0., 0., 0.01}, {8., 0., 0.}, {0., 4., 0.}, floor);
    addBox(scene, {4.5, 1.4, 0.}, {5., 2.6, 3.}, walls);
    return scene;
}

/// The same room without the box and without texture.
inline Scene greyRoom() {
    Scene scene;
    const auto grey = addTexture(scene, uniformTexture(0.6F));
    addBox(scene, {0., 0., 0.}, {8., 4., 3.}, grey, BoxInside::hollow);
    return scene;
}

/// From the start to its other end: a small camera 45 degrees down, any heading.
inline Config flightThroughRoom() {
    Config config;
    config.bounds = {Eigen::Vector3d(0.4, 0.4, 0.8), Eigen::Vector3d(7.6, 3.6, 1.4)};
    config.start.position = {1., 2., 1.1};
    config.start.yaw = 0.;
    config.goal.position = {7., 2., 1.1};
    config.space = StateKind::positionYaw;
    config.robotRadius = 0.25;
    config.camera.mount = "front45";
    config.camera.width = 94;
    config.camera.height = 60;
    config.photometric.scale = 1.;  // independent noise
    config.planner = "rrt_star";
    config.explore.range = 3.;
    config.explore.vertices = 250;
    config.explore.timeLimit = 120.;
    return config;
}

}  // namespace photonav::test
