// SPDX-License-Identifier: BSD-3-Clause
// The paper's first scene for tutorials 6 to 9: a floor that is white on the left and textured on
// the right (x > 4.95 m), a robot at a height of 2 m, a camera that looks straight down.
#pragma once

#include <memory>
#include <numbers>

#include "belief/belief.hpp"
#include "render/mesh_renderer.hpp"
#include "scene_argument.hpp"

namespace two_textures {

using namespace photonav;

inline std::shared_ptr<const ViewSource> loadFloor(int argc, char** argv) {
    return std::make_shared<MeshRenderer>(sceneArgument(argc, argv, "two_textures.yaml"));
}

inline FlightSpace flightSpace() {
    return {StateKind::position, {Eigen::Vector3d(-1., -0.5, 2.), Eigen::Vector3d(9., 9.5, 2.)}};
}

/// Information of views of `floor`, one per cell of `pitch` metres.
inline std::shared_ptr<InformationField> views(const std::shared_ptr<const ViewSource>& floor,
                                               double pitch) {
    const Camera camera = makeCamera(188, 120, 70. * std::numbers::pi / 180.);
    return std::make_shared<InformationField>(
        floor, camera, photometricModel(camera, {.sigma = 0.02, .scale = 0.08}),
        cameraMount(std::numbers::pi / 2.), InformationField::Options{.positionPitch = pitch});
}

inline BeliefOptions beliefs(double alpha) {
    BeliefOptions options;
    options.alpha = alpha;
    options.initialCovariance.diagonal() << 0.115, 0.115, 0.038, 5e-6, 5e-6, 5e-5;
    options.motionNoise.diagonal() << 1e-4, 1e-4, 1e-4, 4.5e-6, 4.5e-6, 1.35e-4;  // per metre
    return options;
}

}  // namespace two_textures
