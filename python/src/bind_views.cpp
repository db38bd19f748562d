// SPDX-License-Identifier: BSD-3-Clause
// Scenes, maps, views and what they are worth.
#include <cmath>
#include <limits>

#include "bindings.hpp"
#include "config/config.hpp"
#include "conversions.hpp"
#include "interruptible.hpp"
#include "map/map_fusion.hpp"
#include "map/octree_file.hpp"
#include "photometry/photometric.hpp"
#include "problem/tracking_map.hpp"
#include "render/voxel_renderer.hpp"
#include "views.hpp"

namespace photonav::python {
namespace {

py::tuple rendered(const Views& views, const Camera& camera, const Array& T_c_w) {
    const Pose pose = poseOf(T_c_w, "T_c_w");
    View view;
    {
        const py::gil_scoped_release release;
        views.source->render(camera, pose, view);
    }
    return py::make_tuple(arrayOf(view.intensity), arrayOf(view.depth));
}

Views loadViews(const py::object& file) {
    const std::string name = pathOf(file);
    return interruptible([&](const std::atomic<bool>&) {
        const TrackingMap map = loadTrackingMap(name);
        return Views{map.views, map.resolution()};
    });
}

PhotometricOptions optionsOf(double sigma, double scale, int stride) {
    if (!(sigma > 0.)) throw py::value_error("sigma: must be positive");
    if (!(scale >= 0.)) throw py::value_error("scale: must not be negative");
    if (stride < 1) throw py::value_error("stride: must be at least 1");
    PhotometricOptions options;
    options.sigma = sigma;
    options.scale = scale;
    options.stride = stride;
    return options;
}

Matrix6 information(const py::object& image, const FloatArray& depth, const Camera& camera,
                    double sigma, double scale, int stride) {
    return photometricInformation(viewOf(image, depth, camera), camera,
                                  optionsOf(sigma, scale, stride));
}

FloatArray contribution(const py::object& image, const FloatArray& depth, const Camera& camera,
                        const std::optional<Array>& direction, double sigma, double scale) {
    const View view = viewOf(image, depth, camera);
    const PhotometricOptions options = optionsOf(sigma, scale, 1);
    if (!direction) return arrayOf(contributionImage(view, camera, options));
    const Vector6 d = vectorOf(*direction, 6, "direction");
    return arrayOf(contributionImage(view, camera, d, options));
}

std::size_t fused(TexturedOcTree& map, const py::object& image, const FloatArray& depth,
                  const Camera& camera, const Array& T_c_w, double maxRange) {
    if (!(maxRange > 0.)) throw py::value_error("max_range: must be positive");
    const View view = viewOf(image, depth, camera);
    const Pose pose = poseOf(T_c_w, "T_c_w");
    FusionOptions options;
    options.maxRange = maxRange;
    const py::gil_scoped_release release;
    return fuse(map, view, camera, pose, options).occupancy.size();
}

py::tuple occupied(const TexturedOcTree& map) {
    std::vector<Eigen::Vector3d> centres;
    std::vector<float> greys;
    for (auto cell = map.begin_leafs(); cell != map.end_leafs(); ++cell) {
        if (!map.isNodeOccupied(*cell)) continue;
        centres.emplace_back(cell.getX(), cell.getY(), cell.getZ());
        greys.push_back(cell->meanGrey().value_or(std::numeric_limits<float>::quiet_NaN()));
    }
    return py::make_tuple(stacked(centres),
                          FloatArray(static_cast<py::ssize_t>(greys.size()), greys.data()));
}

void bindMap(py::module_& module) {
    using namespace py::literals;
    py::class_<TexturedOcTree>(module, "Map", "A textured OctoMap, made image by image.")
        .def(py::init<double>(), "resolution"_a = 0.05)
        .def_static(
            "load", [](const py::object& file) { return loadTexturedOcTree(pathOf(file)); },
            "file"_a, "Reads a textured OctoMap (.ot), as save() and `photonav map` write it.")
        .def(
            "save",
            [](const TexturedOcTree& map, const py::object& file) {
                saveTexturedOcTree(map, pathOf(file));
            },
            "file"_a, "Writes the map as an OctoMap file (.ot); an existing file is replaced.")
        .def(
            "fuse", &fused, "image"_a, "depth"_a, "camera"_a, "T_c_w"_a, "max_range"_a = 4.,
            "Adds an image with depth taken at a pose. image: grey values in [0, 1], or uint8, "
            "which "
            "is divided by 255. depth: [m], 0: no surface. Returns in how many bricks of 4^3 cells "
            "occupancy changed.")
        .def("occupied", &occupied,
             "Centres (N, 3) and mean grey values (N,) of the occupied cells; NaN: never observed.")
        .def(
            "views",
            [](const TexturedOcTree& map) {
                return Views{std::make_shared<VoxelRenderer>(map, UnknownPolicy::free),
                             map.getResolution()};
            },
            "A snapshot to render views from.")
        .def_property_readonly(
            "resolution", [](const TexturedOcTree& map) { return map.getResolution(); },
            "Edge of a cell [m].");
}

}  // namespace

void bindViews(py::module_& module) {
    using namespace py::literals;
    py::class_<Views>(module, "Views", "A scene, mesh or map from which views are rendered.")
        .def_static("load", &loadViews, "file"_a,
                    "A scene (.yaml), a mesh (.glb, .obj, .ply) or a textured OctoMap (.ot, .bt).")
        .def_readonly("cell_size", &Views::cellSize,
                      "Of the cells of a map [m]; 0 for scenes and meshes.")
        .def("render", &rendered, "camera"_a, "T_c_w"_a,
             "Noise-free image in [0, 1] and depth [m] (0: no surface), both (height, width).");
    bindMap(module);
    module.def("information", &information, "image"_a, "depth"_a, "camera"_a, "sigma"_a = 0.02,
               "scale"_a = kSmoothedNoiseScale, "stride"_a = 1,
               "Fisher information (6, 6) of the camera pose from one noise-free image with depth, "
               "camera frame. image: grey values in [0, 1], or uint8, which is divided by 255. "
               "depth: [m], 0: no surface.");
    module.def("contribution", &contribution, "image"_a, "depth"_a, "camera"_a,
               "direction"_a = py::none(), "sigma"_a = 0.02, "scale"_a = kSmoothedNoiseScale,
               "What every pixel adds to the information about a direction (6,), or about all "
               "together. image and depth: as for information().");
}

}  // namespace photonav::python
