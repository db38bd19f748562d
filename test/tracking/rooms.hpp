// SPDX-License-Identifier: BSD-3-Clause
// Scenes to get lost in, and poses in them.
#pragma once

#include <numbers>
#include <random>

#include "alignment/alignment.hpp"
#include "geometry/se3.hpp"
#include "render/area_sensor.hpp"
#include "render/mesh_renderer.hpp"

namespace photonav::test {

/// A room of 6 x 6 x 3 m with textured floor and walls and a few boxes.
inline Scene texturedRoom() {
    Scene scene;
    const auto floor = addTexture(scene, valueNoise({.size = {6., 6.}, .seed = 1}));
    const auto walls = addTexture(scene, valueNoise({.size = {6., 3.}, .seed = 2}));
    const auto crates = addTexture(scene, valueNoise({.size = {1., 1.}, .seed = 3}));
    addBox(scene, {0., 0., 0.}, {6., 6., 3.}, walls, BoxInside::hollow);
    addPlane(scene, {0., 0., 0.01}, {6., 0., 0.}, {0., 6., 0.}, floor);
    addBox(scene, {3.8, 2.4, 0.}, {4.3, 2.9, 0.6}, crates);
    addBox(scene, {3.2, 3.6, 0.}, {3.6, 4.2, 0.4}, crates);
    return scene;
}

inline const MeshRenderer& room() {
    static const MeshRenderer renderer(texturedRoom());
    return renderer;
}

/// A large floor of one texture.
inline Scene floorOf(Texture texture) {
    Scene scene;
    const auto index = addTexture(scene, std::move(texture));
    addPlane(scene, {-10., -10., 0.}, {20., 0., 0.}, {0., 20., 0.}, index);
    return scene;
}

/// A white floor with a carpet of 2 x 2 m, whose nearest corner is at (0.6, 0.2).
inline Scene carpetOnWhite() {
    Scene scene = floorOf(uniformTexture(0.9F));
    addPlane(scene, {0.6, 0.2, 0.01}, {2., 0., 0.}, {0., 2., 0.},
             addTexture(scene, valueNoise({.size = {2., 2.}, .seed = 3})));
    return scene;
}

/// Above bars along world y, turned a little against them; y is hardly known.
inline UncertainPose aboveBars(double turned) {
    Vector6 sigmas;
    sigmas << 0.02, 0.5, 0.05, 0.005, 0.005, 0.01;
    constexpr double kDownward = std::numbers::pi / 2.;
    return {lookFrom({0.13, 0.2, 2.}, kDownward, kDownward + turned),
            sigmas.cwiseAbs2().asDiagonal()};
}

/// The twist from an estimate to the truth, in the camera.
inline Vector6 errorOf(const Alignment& a, const Pose& truth) {
    return logSE3(truth * a.T_c_w.inverse());
}

/// Normalised squared error per degree of freedom: about 1 in the mean if covariances are right.
inline double neesOf(const Alignment& a, const Pose& truth) {
    const Vector6 xi = errorOf(a, truth);
    return xi.dot(a.covariance.ldlt().solve(xi)) / 6.;
}

inline constexpr double kDown = std::numbers::pi / 2.;
inline constexpr double kOblique = std::numbers::pi / 4.;

/// A photograph: not by the renderer that predicts views, and without noise.
inline View photographed(const ViewSource& world, const Camera& camera, const Pose& T_c_w) {
    View view;
    AreaSensor(world).render(camera, T_c_w, view);
    return view;
}

inline ImageF noisy(const ImageF& image, double sigma, std::mt19937_64& random) {
    std::normal_distribution<float> noise(0.F, static_cast<float>(sigma));
    ImageF result = image;
    for (unsigned i = 0; i < result.getSize(); ++i) result.bitmap[i] += noise(random);
    return result;
}

/// A twist of the given lengths in a random direction.
inline Vector6 randomTwist(double metres, double radians, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    const auto direction = [&] {
        Eigen::Vector3d d;
        for (double& component : d) component = normal(random);
        return Eigen::Vector3d(d.normalized());
    };
    Vector6 xi;
    xi.head<3>() = metres * direction();
    xi.tail<3>() = radians * direction();
    return xi;
}

}  // namespace photonav::test
