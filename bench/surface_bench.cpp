// SPDX-License-Identifier: BSD-3-Clause
// Surfaces inside the cells of a map against surfaces at the faces of its cells, both in one run:
// errors of depth and of localisation in views that were not fused, against the mesh that the map
// was made from, and the times of fusion and of views. Maps of a furnished hall as it stands, with
// its world shifted against the cells, tilted by 20 degrees, and from noisy depth.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "alignment/dense_aligner.hpp"
#include "bench_arguments.hpp"
#include "estimation/calibration.hpp"
#include "geometry/se3.hpp"
#include "map/map_fusion.hpp"
#include "render/mesh_renderer.hpp"
#include "render/voxel_renderer.hpp"
#include "statistics.hpp"
#include "thread_time.hpp"
#include "tracking_scenes.hpp"

using namespace photonav;

namespace {

constexpr double kPi = std::numbers::pi;

struct World {
    const char* name;
    Pose T_s_w = Pose::Identity();  ///< the map's world in the scene
    double depthNoise = 0.;         ///< standard deviation at 1 m, grows with the depth squared [m]
};

std::vector<World> makeWorlds() {
    World shifted{"shifted by 5 mm"}, tilted{"tilted by 20 degrees"};
    shifted.T_s_w.translation() = Eigen::Vector3d(0.005, 0.005, 0.005);
    tilted.T_s_w = expSE3((Vector6() << 0.1, 0.2, 0.3, 0., 0., 0.).finished());
    tilted.T_s_w.linear() =
        Eigen::AngleAxisd(kPi / 9., Eigen::Vector3d(1., 2., 0.5).normalized()).toRotationMatrix();
    return {{"as it stands"}, shifted, tilted, {"noisy depth", Pose::Identity(), 1.5e-3}};
}

void addNoise(View& view, double depthNoise, std::mt19937& random) {
    std::normal_distribution<float> normal;
    for (unsigned i = 0; depthNoise > 0. && i < view.depth.getSize(); ++i) {
        float& z = view.depth.bitmap[i];
        if (z > 0.F) z += static_cast<float>(depthNoise) * z * z * normal(random);
    }
}

struct MadeMap {
    TexturedOcTree map;
    double fuse = 0.;  ///< [ms] a frame
};

MadeMap makeMap(const MeshRenderer& mesh, const World& world, double resolution, bool surfaces) {
    MadeMap made{TexturedOcTree(resolution)};
    const Camera camera = makeCamera(376, 240, 70. * kPi / 180.);
    std::mt19937 random(1);
    int frames = 0;
    View view;
    for (const double below : {0.2, 0.8, 1.5}) {
        for (int i = 0; i < 40; ++i, ++frames) {
            const Pose T_c_s = onCircle(2. * kPi * i / 40, below);
            mesh.render(camera, T_c_s, view);
            addNoise(view, world.depthNoise, random);
            const double begin = threadTime();
            fuse(made.map, view, camera, T_c_s * world.T_s_w,
                 {.maxRange = std::min(8., 300. * resolution), .surfaces = surfaces});
            made.fuse += threadTime() - begin;
        }
    }
    made.fuse /= frames;
    return made;
}

/// Errors of depth [mm].
struct DepthErrors {
    std::vector<double> all;
    double sum = 0.;

    void add(double error) {
        all.push_back(1e3 * std::abs(error));
        sum += 1e3 * error;
    }
    std::string text() const {
        return fmt::format("{:6.1f} {:6.1f}", sum / double(all.size()), quantile(all, 0.9));
    }
};

/// Cosine between the ray of a pixel and the surface's normal; 0 at edges.
double incidence(const View& view, const Camera& camera, unsigned u, unsigned v) {
    const auto at = [&](unsigned i, unsigned j) {
        return camera.unproject(i, j, view.depth[j][i]);
    };
    const Eigen::Vector3d normal = (at(u + 1, v) - at(u - 1, v)).cross(at(u, v + 1) - at(u, v - 1));
    return std::abs(normal.normalized().dot(at(u, v).normalized()));
}

struct Result {
    DepthErrors depth, grazing;
    std::vector<double> localisation;  ///< [mm]
    std::size_t missing = 0, wrong = 0, pixels = 0;
    int lost = 0;
    double render = 0.;  ///< [ms]
};

void compareDepth(const View& truth, const View& seen, const Camera& camera, Result& result) {
    for (unsigned v = 1; v + 1 < camera.height; ++v) {
        for (unsigned u = 1; u + 1 < camera.width; ++u) {
            const double z = truth.depth[v][u];
            if (!(z > 0.)) continue;
            ++result.pixels;
            if (!(seen.depth[v][u] > 0.F)) {
                ++result.missing;
                continue;
            }
            const double error = seen.depth[v][u] - z;
            if (std::abs(error) > 0.3) ++result.wrong;
            if (std::abs(error) > 0.3) continue;
            result.depth.add(error);
            if (incidence(truth, camera, u, v) < 0.34) result.grazing.add(error);
        }
    }
}

Result judge(const MeshRenderer& mesh, const VoxelRenderer& map, const World& world) {
    const Camera camera = trackingCamera();
    AlignmentOptions options;
    options.modelNoise = ModelNoise::inPose;
    DenseAligner aligner(map, camera, options);
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    Result result;
    View truth, seen;
    int views = 0;
    for (const double below : {0.25 * kPi, 0.4, 1.2}) {
        for (int i = 0; i < 30; ++i, ++views) {
            const Pose T_c_s = onCircle(2. * kPi * (i + 0.37) / 30, below);
            const Pose T_c_w = T_c_s * world.T_s_w;
            mesh.render(camera, T_c_s, truth);
            double least = 1e30;
            for (int k = 0; k < 5; ++k) {
                const double begin = threadTime();
                map.render(camera, T_c_w, seen);
                least = std::min(least, threadTime() - begin);
            }
            result.render += least;
            compareDepth(truth, seen, camera, result);
            for (unsigned p = 0; p < truth.intensity.getSize(); ++p) {
                truth.intensity.bitmap[p] += static_cast<float>(0.02 * normal(random));
            }
            Vector6 xi, sigmas;
            sigmas << Eigen::Vector3d::Constant(0.02), Eigen::Vector3d::Constant(0.017);
            for (int a = 0; a < 6; ++a) xi[a] = sigmas[a] * normal(random);
            const UncertainPose prior{expSE3(xi) * T_c_w, sigmas.cwiseAbs2().asDiagonal()};
            const Alignment a = aligner.align(truth.intensity, prior);
            result.lost += isLost(a.verdict) ? 1 : 0;
            const Pose error = T_c_w * a.T_c_w.inverse();
            result.localisation.push_back(1e3 * error.translation().norm());
        }
    }
    result.render /= views;
    return result;
}

std::size_t occupiedCells(const TexturedOcTree& map) {
    std::size_t cells = 0;
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        cells += map.isNodeOccupied(*leaf) ? 1 : 0;
    }
    return cells;
}

void compare(const MeshRenderer& mesh, const World& world, double resolution) {
    fmt::print("\n{:.3g} cm, {}\n", 100. * resolution, world.name);
    std::array<double, 2> fuseTime{}, renderTime{};
    for (const bool surfaces : {false, true}) {
        const MadeMap made = makeMap(mesh, world, resolution, surfaces);
        const VoxelRenderer views(made.map, UnknownPolicy::free);
        const Result r = judge(mesh, views, world);
        fuseTime[surfaces] = made.fuse;
        renderTime[surfaces] = r.render;
        fmt::print(
            "  {:9} depth {} mm, grazing {} mm, missing {:.2f} %, off by 0.3 m {:.2f} %; "
            "localised {:5.1f} {:5.1f} mm, {} lost; fuse {:.2f} render {:.3f} ms; {} cells\n",
            surfaces ? "surfaces" : "faces", r.depth.text(), r.grazing.text(),
            100. * double(r.missing) / double(r.pixels), 100. * double(r.wrong) / double(r.pixels),
            quantile(r.localisation, 0.5), quantile(r.localisation, 0.9), r.lost, made.fuse,
            r.render, occupiedCells(made.map));
        std::fflush(stdout);
    }
    fmt::print("  time with surfaces: fuse {:.2f}, render {:.2f} of the time without\n",
               fuseTime[1] / fuseTime[0], renderTime[1] / renderTime[0]);
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv, "surface_bench [CELL_SIZE]");
    const MeshRenderer mesh(furnishedHall());
    fmt::print("errors: mean and p90 of depth, median and p90 of localisation\n");
    std::vector<double> resolutions{0.05, 0.025, 0.01};
    if (const double one = arguments.number(1, 0.); one > 0.) resolutions = {one};
    for (const double resolution : resolutions) {
        for (const World& world : makeWorlds()) compare(mesh, world, resolution);
    }
}
