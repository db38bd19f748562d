// SPDX-License-Identifier: BSD-3-Clause
// A map needs depth. Three sensors give it on the same flight: a depth camera, a pair of cameras,
// and one camera that moves. How good is their depth, and what is a map of it worth?
#include <algorithm>
#include <cstdio>
#include <random>

#include "depth/monocular_depth.hpp"
#include "depth/stereo_depth.hpp"
#include "exercises.hpp"
#include "figures/images.hpp"
#include "geometry/constants.hpp"
#include "map/map_fusion.hpp"
#include "photometry/photometric.hpp"
#include "render/mesh_renderer.hpp"
#include "render/voxel_renderer.hpp"
#include "simulation/camera_noise.hpp"

using namespace photonav;

namespace {

constexpr int kImages = 60;
constexpr double kBaseline = 0.11;  // of the pair [m]

/// A crate on a carpet, a wall behind.
Scene crateOnCarpet() {
    Scene scene;
    const auto carpet = addTexture(scene, valueNoise({.cells = {0.4, 0.2, 0.06}, .seed = 1}));
    const auto plaster = addTexture(scene, valueNoise({.cells = {0.5, 0.1}, .mean = 0.6}));
    const auto boards = addTexture(scene, checker({.cell = 0.28, .softEdge = 0.06}));
    addPlane(scene, {-4., 4., -0.01}, {8., 0., 0.}, {0., -8., 0.}, carpet);
    addPlane(scene, {2.51, 4., 2.5}, {0., -8., 0.}, {0., 0., -2.51}, plaster);
    addBox(scene, {0.61, -0.43, -0.01}, {1.44, 0.42, 0.69}, boards);
    return scene;
}

/// 2.4 m sideways past the crate, camera 45 degrees down.
Pose flight(double share) {
    Pose T_w_b = Pose::Identity();
    T_w_b.translation() << -0.6, 1.2 - 2.4 * share, 1.6;
    return (T_w_b * cameraMount(45. * kDegree)).inverse();
}

View trueView(const ViewSource& scene, const Camera& camera, const Pose& T_c_w) {
    View view;
    scene.render(camera, T_c_w, view);
    return view;
}

ImageF picture(const ViewSource& scene, const Camera& camera, const Pose& T_c_w,
               std::mt19937_64& random) {
    CameraNoiseOptions options;
    options.vignetting = 0.;
    return takePicture(trueView(scene, camera, T_c_w).intensity, options, random);
}

//! [monocular]
/// One camera that moves: a filter per reference image, updated by the images around it.
std::vector<std::pair<Pose, View>> byMotion(const ViewSource& scene, const Camera& camera) {
    std::mt19937_64 random(1);
    MonocularDepth depth(camera);
    std::vector<std::pair<Pose, View>> views;
    const auto take = [&](const std::optional<DepthFilter>& finished) {
        if (finished) views.emplace_back(finished->pose(), finished->view());
    };
    for (int i = 0; i < kImages; ++i) {
        const Pose T_c_w = flight(double(i) / kImages);
        take(depth.add(picture(scene, camera, T_c_w, random), T_c_w));
    }
    take(depth.finish());
    return views;
}
//! [monocular]

vpImage<unsigned char> bytes(const ImageF& image) {
    vpImage<unsigned char> result(image.getHeight(), image.getWidth());
    for (unsigned i = 0; i < image.getSize(); ++i) result.bitmap[i] = greyLevel(image.bitmap[i]);
    return result;
}

//! [stereo]
/// A pair of cameras: z = f b / d, with the disparity d of each block of pixels.
View byStereo(const ViewSource& scene, const Camera& camera, const Pose& T_c_w) {
    std::mt19937_64 random(1);
    DistortedCamera left{camera, Eigen::Vector4d::Zero(), Pose::Identity(), {}};
    DistortedCamera right = left;
    right.T_b_c.translation().x() = kBaseline;
    StereoDepth stereo(left, right, {.halvings = 0});
    View view;
    stereo({bytes(picture(scene, camera, T_c_w, random)),
            bytes(picture(scene, camera, right.T_b_c.inverse() * T_c_w, random))},
           view);
    return view;
}
//! [stereo]

/// A depth camera, whose error grows with depth squared.
View bySensor(const ViewSource& scene, const Camera& camera, const Pose& T_c_w) {
    std::mt19937_64 random(1);
    View view = trueView(scene, camera, T_c_w);
    addDepthNoise(view.depth, DepthNoiseOptions{}, random);
    view.intensity = picture(scene, camera, T_c_w, random);
    return view;
}

struct DepthErrors {
    std::vector<double> relative;
    std::size_t pixels = 0;

    void add(const View& measured, const View& truth) {
        pixels += truth.depth.getSize();
        for (unsigned i = 0; i < truth.depth.getSize(); ++i) {
            const double z = measured.depth.bitmap[i];
            const double trueZ = truth.depth.bitmap[i];
            if (z > 0.) relative.push_back(std::abs(z - trueZ) / trueZ);
        }
    }

    double median() {
        const auto middle = relative.begin() + std::ptrdiff_t(relative.size() / 2);
        std::nth_element(relative.begin(), middle, relative.end());
        return *middle;
    }
};

std::vector<Exercise> exercises(const Camera& camera) {
    const double disparity = camera.fx() * kBaseline / 2.;  // at 2 m [pixels]
    return {{[=] { return disparity; }},
            {[=] { return 100. * 2. * 0.2 / disparity; }}};  // of 0.2 pixels [cm]
}

}  // namespace

int main(int argc, char** argv) {
    const Camera camera = makeCamera(376, 240, 70. * kDegree);
    if (const auto code = checkAnswers(argc, argv, exercises(camera))) return *code;
    const MeshRenderer scene(crateOnCarpet());
    const auto references = byMotion(scene, camera);

    const Pose T_judge_w = flight(0.45);
    const View truth = trueView(scene, camera, T_judge_w);
    std::vector<CaptionedImage> images{{"the scene", greyPicture(truth.intensity)}};
    std::puts("depth from     pixels  median error   information of a view of the map");
    for (const std::string sensor : {"a sensor", "two cameras", "one camera"}) {
        //! [map]
        DepthErrors errors;
        TexturedOcTree map(0.05);
        for (const auto& [T_c_w, byOne] : references) {
            const View view = sensor == "a sensor"      ? bySensor(scene, camera, T_c_w)
                              : sensor == "two cameras" ? byStereo(scene, camera, T_c_w)
                                                        : byOne;
            errors.add(view, trueView(scene, camera, T_c_w));
            fuse(map, view, camera, T_c_w, {.maxRange = 5.});
        }
        const View view = trueView(VoxelRenderer(map, UnknownPolicy::free), camera, T_judge_w);
        const double information = photometricInformation(view, camera).trace() /
                                   photometricInformation(truth, camera).trace();
        //! [map]
        std::printf("%-12s %6.0f %%  %10.2f %%  %12.0f %%\n", sensor.c_str(),
                    100. * double(errors.relative.size()) / double(errors.pixels),
                    100. * errors.median(), 100. * information);
        images.push_back({"map of depth from " + sensor, predictedPicture(view)});
    }
    imagesFigure({{images[0], images[1]}, {images[2], images[3]}}, 376.).save("mapping_depth.png");
    std::puts("wrote mapping_depth.png");
}
