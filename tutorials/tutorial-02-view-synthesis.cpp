// SPDX-License-Identifier: BSD-3-Clause
// What would a camera see from a given pose? Views from the triangles of a scene, and from an
// OctoMap that was built of other views of it; and how much of the scene's information the cells of
// a map keep.
#include <cstdio>
#include <numbers>

#include "exercises.hpp"
#include "figures/images.hpp"
#include "map/map_fusion.hpp"
#include "photometry/photometric.hpp"
#include "render/mesh_renderer.hpp"
#include "render/voxel_renderer.hpp"

using namespace photonav;

namespace {

//! [scene]
/// A crate on a carpet, a wall behind. Surfaces are a little off the borders of the map's cells, as
/// real ones are.
Scene crateOnCarpet() {
    Scene scene;
    const auto carpet = addTexture(scene, valueNoise({.cells = {0.8, 0.4, 0.2}, .seed = 1}));
    const auto plaster = addTexture(scene, valueNoise({.cells = {1., 0.5}, .mean = 0.6}));
    const auto boards = addTexture(scene, checker({.cell = 0.28, .softEdge = 0.06}));
    addPlane(scene, {-4., 4., -0.01}, {8., 0., 0.}, {0., -8., 0.}, carpet);
    addPlane(scene, {2.51, 4., 2.5}, {0., -8., 0.}, {0., 0., -2.51}, plaster);
    addBox(scene, {0.61, -0.43, -0.01}, {1.44, 0.42, 0.69}, boards);
    return scene;
}
//! [scene]

Pose bodyAt(const Eigen::Vector3d& position) { return Pose(Eigen::Translation3d(position)); }

//! [map]
/// Flies over the scene with both cameras and enters what they see into a map.
TexturedOcTree mapScene(const ViewSource& scene, const Camera& camera, double resolution) {
    TexturedOcTree map(resolution);
    View view;
    for (const double x : {-1., -0.4, 0.2, 0.8}) {
        for (const double y : {-0.8, 0., 0.8}) {
            for (const double belowHorizon : {std::numbers::pi / 2., std::numbers::pi / 4.}) {
                const Pose T_w_c = bodyAt({x, y, 2.}) * cameraMount(belowHorizon);
                scene.render(camera, T_w_c.inverse(), view);
                fuse(map, view, camera, T_w_c.inverse());
            }
        }
    }
    return map;
}
//! [map]

//! [compare]
/// Mean absolute difference of the grey values, over the pixels with depth in both views.
double difference(const View& a, const View& b) {
    double sum = 0.;
    int pixels = 0;
    for (unsigned i = 0; i < a.depth.getSize(); ++i) {
        if (a.depth.bitmap[i] <= 0.F || b.depth.bitmap[i] <= 0.F) continue;
        sum += std::abs(a.intensity.bitmap[i] - b.intensity.bitmap[i]);
        ++pixels;
    }
    return sum / std::max(1, pixels);
}

/// The share of the information that a view of the map keeps.
double informationKept(const View& voxels, const View& mesh, const Camera& camera) {
    return photometricInformation(voxels, camera).trace() /
           photometricInformation(mesh, camera).trace();
}
//! [compare]

void compare(const char* name, const View& voxels, const View& mesh, const Camera& camera) {
    std::printf("  %s  mean absolute difference %.3f   information %3.0f %%\n", name,
                difference(voxels, mesh), 100. * informationKept(voxels, mesh, camera));
}

View viewOf(const ViewSource& source, const Camera& camera, double belowHorizon) {
    const Pose T_w_c = bodyAt({0.1, 0.3, 1.8}) * cameraMount(belowHorizon);
    View view;
    source.render(camera, T_w_c.inverse(), view);
    return view;
}

std::vector<Exercise> exercises(const ViewSource& mesh, const Camera& camera) {
    const auto kept = [&](double resolution) {
        const TexturedOcTree map = mapScene(mesh, scaled(camera, 2.), resolution);
        const double down = std::numbers::pi / 2.;
        return 100. * informationKept(viewOf(VoxelRenderer(map, UnknownPolicy::free), camera, down),
                                      viewOf(mesh, camera, down), camera);
    };
    return {{[&] {
                return viewOf(mesh, camera, std::numbers::pi / 4.)
                    .depth[camera.height / 2][camera.width / 2];
            }},
            {[=] { return kept(0.1); }, 0.05}};
}

}  // namespace

int main(int argc, char** argv) {
    const Camera camera = makeCamera(188, 120, 70. * std::numbers::pi / 180.);
    const MeshRenderer mesh(crateOnCarpet());
    if (const auto code = checkAnswers(argc, argv, exercises(mesh, camera))) return *code;
    //! [renderers]
    const Camera fine = scaled(camera, 2.);  // the map is made from larger images
    const VoxelRenderer coarseMap(mapScene(mesh, fine, 0.05), UnknownPolicy::free);
    const VoxelRenderer fineMap(mapScene(mesh, fine, 0.025), UnknownPolicy::free);
    //! [renderers]

    std::vector<std::vector<CaptionedImage>> rows;
    for (const auto& [name, belowHorizon] : {std::pair{"downward camera", std::numbers::pi / 2.},
                                             {"45-degree camera", std::numbers::pi / 4.}}) {
        //! [views]
        const Pose T_w_c = bodyAt({0.1, 0.3, 1.8}) * cameraMount(belowHorizon);
        View truth, coarse, finer;
        mesh.render(camera, T_w_c.inverse(), truth);
        coarseMap.render(camera, T_w_c.inverse(), coarse);
        fineMap.render(camera, T_w_c.inverse(), finer);
        //! [views]
        std::printf("%s, from a pose the map was not made from\n", name);
        compare("cells of 5 cm  ", coarse, truth, camera);
        compare("cells of 2.5 cm", finer, truth, camera);
        rows.push_back({{std::string(name) + ", mesh", greyPicture(truth.intensity)},
                        {"its depth", greyPicture(truth.depth, 0.25)},
                        {"map of 5 cm", predictedPicture(coarse)},
                        {"map of 2.5 cm", predictedPicture(finer)}});
    }
    imagesFigure(rows, 376.).save("view_synthesis.png");
    std::puts("wrote view_synthesis.png");
}
