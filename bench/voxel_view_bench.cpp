// SPDX-License-Identifier: BSD-3-Clause
// View and information from a textured octree, compared with the straightforward way: a castRay of
// OctoMap per pixel and ViSP's luminance feature. Minima are printed; the ratio uses the faster of
// the two castRays. Also: the information of voxel views relative to views of the mesh.
#include <fmt/format.h>
#include <octomap/OcTree.h>
#include <visp3/visual_features/vpFeatureLuminance.h>

#include <numbers>

#include "bench_arguments.hpp"
#include "map/map_fusion.hpp"
#include "photometry/photometric.hpp"
#include "render/mesh_renderer.hpp"
#include "render/voxel_renderer.hpp"
#include "thread_time.hpp"
#include "tracking_scenes.hpp"

using namespace photonav;

namespace {

/// Least time of one call in milliseconds.
template <class Call>
double minTime(int repetitions, const Call& call) {
    double least = 1e30;
    for (int i = 0; i < repetitions; ++i) {
        const double start = threadTime();
        call();
        least = std::min(least, threadTime() - start);
    }
    return least;
}

float texture(double x, double y, double z) {
    return static_cast<float>(0.5 + 0.2 * std::sin(3.1 * x + 2.3 * y + 1.7 * z) +
                              0.2 * std::sin(7.3 * (x - 0.6 * y) + 5.1 * z));
}

/// A room with floor, ceiling, walls and four boxes; every other cell in it is free.
TexturedOcTree makeRoom(const Eigen::Array3i& cells, double resolution) {
    TexturedOcTree map(resolution);
    const auto solid = [&](const Eigen::Array3i& c) {
        const bool shell = (c == 0).any() || (c == cells - 1).any();
        const Eigen::Array2i quarter = cells.head<2>() / 4;
        const Eigen::Array2i inQuarter(c.x() % (2 * quarter.x()), c.y() % (2 * quarter.y()));
        return shell || ((inQuarter - quarter).abs().maxCoeff() < 10 && c.z() < cells.z() / 3);
    };
    for (int z = 0; z < cells.z(); z += 4) {
        for (int y = 0; y < cells.y(); y += 4) {
            for (int x = 0; x < cells.x(); x += 4) {
                std::uint64_t inside = 0, hit = 0;
                for (int i = 0; i < 64; ++i) {
                    const Eigen::Array3i c(x + (i & 3), y + (i >> 2 & 3), z + (i >> 4));
                    if ((c >= cells).any()) continue;
                    const std::uint64_t bit = 1ULL << brickBit(c.x(), c.y(), c.z());
                    inside |= bit;
                    if (solid(c)) hit |= bit;
                }
                const auto observe = [&](TexturedOcTreeNode& node, const auto&, unsigned bit) {
                    const int cx = x + ((bit & 1U) | (bit >> 2U & 2U));
                    const int cy = y + ((bit >> 1U & 1U) | (bit >> 3U & 2U));
                    const int cz = z + ((bit >> 2U & 1U) | (bit >> 4U & 2U));
                    for (FaceTexture& face : node.faces) {
                        face.observe(texture(cx * resolution, cy * resolution, cz * resolution),
                                     1.F);
                    }
                };
                const octomap::OcTreeKey key(32768 + x, 32768 + y, 32768 + z);
                BrickObservation brick{key, inside & ~hit, hit};
                for (int i = 0; i < 6; ++i) map.updateBricks({&brick, 1}, observe);
            }
        }
    }
    return map;
}

/// The straightforward way to a view: a ray of OctoMap per pixel, the nearest face's grey value.
template <class Tree>
void castView(const Tree& map, const Camera& camera, const Pose& T_c_w, View& view) {
    const Pose T_w_c = T_c_w.inverse();
    const auto point = [](const Eigen::Vector3d& p) {
        return octomap::point3d(static_cast<float>(p.x()), static_cast<float>(p.y()),
                                static_cast<float>(p.z()));
    };
    const octomap::point3d eye = point(T_w_c.translation());
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            const Eigen::Vector3d ray((u - camera.cx()) / camera.fx(),
                                      (v - camera.cy()) / camera.fy(), 1.);
            octomap::point3d end;
            const bool hit = map.castRay(eye, point(T_w_c.linear() * ray), end, true);
            view.depth[v][u] = hit ? static_cast<float>((end - eye).norm() / ray.norm()) : 0.F;
            if constexpr (std::is_same_v<Tree, TexturedOcTree>) {
                view.intensity[v][u] = hit ? map.search(end)->faces[5].mean : 0.F;
            }
        }
    }
}

/// ViSP's luminance feature, one object for all views, and J^T J.
class VispInformation {
  public:
    explicit VispInformation(const Camera& camera) : image_(camera.height, camera.width) {
        vpCameraParameters intrinsics = camera.intrinsics;
        feature_.setCameraParameters(intrinsics);
        feature_.init(camera.height, camera.width, 2.);
    }

    vpMatrix operator()(const View& view) {
        for (unsigned i = 0; i < image_.getSize(); ++i) {
            image_.bitmap[i] = static_cast<unsigned char>(255.F * view.intensity.bitmap[i]);
        }
        feature_.buildFrom(image_);
        feature_.interaction(interaction_);
        return interaction_.AtA();
    }

  private:
    vpImage<unsigned char> image_;
    vpFeatureLuminance feature_;
    vpMatrix interaction_;
};

void compareViews(const char* name, const TexturedOcTree& map, const octomap::OcTree& occupancy,
                  const VoxelRenderer& renderer, const std::vector<Pose>& poses) {
    const Camera camera = makeCamera(188, 120, 70. * std::numbers::pi / 180.);
    View view;
    view.intensity.resize(camera.height, camera.width);
    view.depth.resize(camera.height, camera.width);
    VispInformation visp(camera);
    double casting = 0., castingTextured = 0., luminance = 0., rendering = 0., ours = 0.;
    double trace = 0.;
    for (const Pose& T_c_w : poses) {
        casting += minTime(5, [&] { castView(occupancy, camera, T_c_w, view); });
        castingTextured += minTime(5, [&] { castView(map, camera, T_c_w, view); });
        luminance += minTime(20, [&] { trace += visp(view)[0][0]; });
        rendering += minTime(40, [&] { renderer.render(camera, T_c_w, view); });
        ours += minTime(40, [&] {
            renderer.render(camera, T_c_w, view);
            trace += photometricInformation(view, camera).trace();
        });
    }
    const double n = static_cast<double>(poses.size());
    const double plain = std::min(casting, castingTextured) + luminance;
    fmt::print(
        "{:<12} castRay {:6.2f} ms (textured tree {:6.2f}) + ViSP {:5.3f} ms | render {:5.3f} "
        "ms, with information {:5.3f} ms | ratio {:5.1f}   [{:.1e}]\n",
        name, casting / n, castingTextured / n, luminance / n, rendering / n, ours / n,
        plain / ours, trace);
}

std::vector<Pose> posesAt(double belowHorizon) {
    std::vector<Pose> poses;
    for (int i = 0; i < 8; ++i) {
        poses.push_back(
            lookFrom({4. + 1.6 * i, 3. + 1.9 * (i * 5 % 8), 2.05}, belowHorizon, 0.7 * i));
    }
    return poses;
}

void timeFusion(const VoxelRenderer& renderer, double resolution) {
    const Camera camera = makeCamera(640, 480, 62. * std::numbers::pi / 180.);
    TexturedOcTree map(resolution);
    double total = 0., slowest = 0.;
    for (int i = 0; i < 30; ++i) {
        const Pose T_c_w = lookFrom({5. + 0.02 * i, 5., 1.5}, 0.5, 0.02 * i);
        View view;
        renderer.render(camera, T_c_w, view);
        const double time = minTime(1, [&] { fuse(map, view, camera, T_c_w); });
        total += time;
        slowest = std::max(slowest, time);
    }
    fmt::print("fuse 640x480 into {:.3f} m cells: {:.1f} ms a frame, slowest {:.1f} ms\n",
               resolution, total / 30., slowest);
}

/// Trace of Lambda in a map's views relative to those of the mesh that it was made from.
void printInformation(double resolution) {
    const MeshRenderer mesh(furnishedHall());
    const Camera camera = trackingCamera();
    const Camera recorder = makeCamera(376, 240, 70. * std::numbers::pi / 180.);
    TexturedOcTree map(resolution);
    View view;
    for (const double below : {0.6, 1.0, 1.5}) {
        for (int i = 0; i < 40; ++i) {
            const Pose T_c_w = onCircle(2. * std::numbers::pi * i / 40, below);
            mesh.render(recorder, T_c_w, view);
            fuse(map, view, recorder, T_c_w);
        }
    }
    const VoxelRenderer voxels(map, UnknownPolicy::free);
    const auto traces = [&](const ViewSource& source, double below) {
        double sum = 0.;
        for (int i = 0; i < 8; ++i) {
            source.render(camera, onCircle(0.1 + 0.25 * std::numbers::pi * i, below), view);
            sum += photometricInformation(view, camera).trace();
        }
        return sum;
    };
    for (const auto& [name, below] : {std::pair{"down", 1.5}, {"45 degrees", 0.785}}) {
        fmt::print("information of the voxel view, {} m cells, {}: {:.2f} of the mesh view's\n",
                   resolution, name, traces(voxels, below) / traces(mesh, below));
    }
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv, "voxel_view_bench");
    const double resolution = 0.05;
    const TexturedOcTree map = makeRoom({400, 400, 60}, resolution);
    octomap::OcTree occupancy(resolution);
    std::size_t solid = 0;
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        if (!map.isNodeOccupied(*leaf)) continue;
        occupancy.setNodeValue(leaf.getKey(), 1.F, true);
        const double edge = leaf.getSize() / resolution;
        solid += static_cast<std::size_t>(std::lround(edge * edge * edge));
    }
    occupancy.updateInnerOccupancy();
    fmt::print("room 20 x 20 x 3 m, {} solid cells of {} m, {} nodes; 188x120 views, one thread\n",
               solid, resolution, map.size());

    const VoxelRenderer renderer(map, UnknownPolicy::free);
    compareViews("down, 2 m", map, occupancy, renderer, posesAt(std::numbers::pi / 2));
    compareViews("45 degrees", map, occupancy, renderer, posesAt(std::numbers::pi / 4));
    compareViews("horizontal", map, occupancy, renderer, posesAt(0.));
    fmt::print("rebuild: {:.1f} ms\n",
               minTime(5, [&] { VoxelRenderer(map, UnknownPolicy::free); }));
    View view;
    const Camera camera = makeCamera(188, 120, 1.2);
    renderer.render(camera, lookFrom({5., 5., 2.}, 1.), view);
    fmt::print("point spread alone: {:.4f} ms\n", minTime(100, [&] { applyPointSpread(view); }));
    for (const double cell : {0.05, 0.025}) timeFusion(renderer, cell);
    for (const double cell : {0.05, 0.025}) printInformation(cell);
}
