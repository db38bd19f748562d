// SPDX-License-Identifier: BSD-3-Clause
// How much of the information of images their map keeps.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "core/photometry/synthetic_floor.hpp"
#include "map/map_fusion.hpp"
#include "photometry/photometric.hpp"
#include "render/mesh_renderer.hpp"
#include "render/voxel_renderer.hpp"

namespace photonav {
namespace {

using test::floorView;
using test::kDown;
using test::lookDown;

/// A floor mapped from noisy images of a camera that flies over it, like a recording.
TexturedOcTree mapFloor(double resolution, const test::FloorTexture& texture,
                        double depthNoise = 0.) {
    TexturedOcTree map(resolution);
    const Camera camera = makeCamera(240, 180, 1.1);
    for (int i = 0; i < 12; ++i) {
        const Pose T_c_w = lookDown(-0.7 + 0.3 * (i % 6), -0.3 + 0.6 * (i / 6), 1.4, 1.35, 0.3 * i);
        View view = floorView(camera, T_c_w, texture, 0.02);
        test::addNoise(view.intensity, 0.02, i);
        std::mt19937 random(i);
        std::normal_distribution<double> noise;
        for (unsigned k = 0; depthNoise > 0. && k < view.depth.getSize(); ++k) {
            const double z = view.depth.bitmap[k];
            view.depth.bitmap[k] = static_cast<float>(z + depthNoise * z * z * noise(random));
        }
        fuse(map, view, camera, T_c_w);
    }
    return map;
}

double informationTrace(const ViewSource& source, const Camera& camera, const Pose& T_c_w) {
    View view;
    source.render(camera, T_c_w, view);
    return photometricInformation(view, camera).trace();
}

TEST(VoxelInformation, UniformFloorsMappedFromNoisyImagesCarryNoInformation) {
    const Camera camera = makeCamera(188, 120, 1.2);
    for (const auto& [resolution, depthNoise] :
         {std::pair{0.05, 0.}, {0.025, 0.}, {0.05, 0.0015}, {0.025, 0.0015}}) {
        const auto grey = [](double, double) { return 0.5; };
        const VoxelRenderer carpet(mapFloor(resolution, test::carpet, depthNoise),
                                   UnknownPolicy::free);
        const VoxelRenderer uniform(mapFloor(resolution, grey, depthNoise), UnknownPolicy::free);
        for (const double belowHorizon : {kDown, 0.9}) {
            const Pose T_c_w = lookDown(-0.2, 0., 1.4, belowHorizon, 0.2);
            const double textured = informationTrace(carpet, camera, T_c_w);
            const double faked = informationTrace(uniform, camera, T_c_w);
            EXPECT_GT(textured, 0.);
            EXPECT_LT(faked, 0.01 * textured)
                << resolution << ' ' << depthNoise << ' ' << belowHorizon;
            RecordProperty(fmt::format("faked_{}_{:.2f}", resolution, belowHorizon),
                           fmt::format("{:.6f}", faked / textured));
        }
    }
}

TEST(VoxelInformation, KeepsMostOfTheInformationOfTheOriginalImage) {
    const Camera camera = makeCamera(188, 120, 1.2);
    for (const auto& [resolution, least] : {std::pair{0.05, 0.6}, {0.025, 0.85}}) {
        const VoxelRenderer carpet(mapFloor(resolution, test::carpet), UnknownPolicy::free);
        for (const double belowHorizon : {kDown, 0.9}) {
            const Pose T_c_w = lookDown(-0.2, 0., 1.4, belowHorizon, 0.2);
            View original = floorView(camera, T_c_w, test::carpet, 0.02);
            View seen;
            carpet.render(camera, T_c_w, seen);
            for (unsigned i = 0; i < seen.depth.getSize(); ++i) {  // the same pixels in both
                if (seen.depth.bitmap[i] == 0.F) original.depth.bitmap[i] = 0.F;
            }
            applyPointSpread(original);
            const double kept = photometricInformation(seen, camera).trace() /
                                photometricInformation(original, camera).trace();
            EXPECT_GT(kept, least) << resolution << ' ' << belowHorizon;
            EXPECT_LT(kept, 1.1) << resolution << ' ' << belowHorizon;
            RecordProperty(fmt::format("kept_{}_{:.2f}", resolution, belowHorizon),
                           fmt::format("{:.4f}", kept));
        }
    }
}

TEST(VoxelInformation, KeepsMuchOfTheInformationOfTheMeshItWasMadeFrom) {
    Scene scene;
    const auto carpet = addTexture(scene, valueNoise({.size = {8., 8.}, .seed = 4}));
    addPlane(scene, {-4., -4., 0.02}, {8., 0., 0.}, {0., 8., 0.}, carpet);
    const MeshRenderer mesh(scene);
    const Camera camera = makeCamera(188, 120, 1.2);
    for (const auto& [resolution, least] : {std::pair{0.05, 0.5}, {0.025, 0.7}}) {
        TexturedOcTree map(resolution);
        const Camera recorder = makeCamera(240, 180, 1.1);
        for (int i = 0; i < 12; ++i) {
            const Pose T_c_w =
                lookDown(-0.7 + 0.3 * (i % 6), -0.3 + 0.6 * (i / 6), 1.4, 1.35, 0.3 * i);
            View view;
            mesh.render(recorder, T_c_w, view);
            fuse(map, view, recorder, T_c_w);
        }
        const VoxelRenderer voxels(map, UnknownPolicy::free);
        for (const double belowHorizon : {kDown, 1.2}) {
            const Pose T_c_w = lookDown(-0.2, 0., 1., belowHorizon, 0.2);
            const double kept =
                informationTrace(voxels, camera, T_c_w) / informationTrace(mesh, camera, T_c_w);
            EXPECT_GT(kept, least) << resolution << ' ' << belowHorizon;
            EXPECT_LT(kept, 1.1) << resolution << ' ' << belowHorizon;
        }
    }
}

}  // namespace
}  // namespace photonav
