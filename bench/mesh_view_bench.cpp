// SPDX-License-Identifier: BSD-3-Clause
// View + Fisher information from a mesh of 2.3 k triangles, one thread: MeshRenderer and
// photometricInformation() against one ray at a time (same shading, but one surface per pixel) and
// ViSP's luminance feature, reused from view to view. Prints the fastest of many rounds, both sides
// in the same run.
#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <visp3/visual_features/vpFeatureLuminance.h>

#include <chrono>
#include <limits>
#include <numbers>
#include <random>

#include "bench_arguments.hpp"
#include "photometry/photometric.hpp"
#include "render/mesh_renderer.hpp"
#include "render/surface_shader.hpp"

using namespace photonav;

namespace {

/// A hall of 20 x 20 x 3 m with textured boxes on its floor: 2292 triangles.
Scene hall() {
    Scene scene;
    const auto floor = addTexture(scene, valueNoise({.size = {8., 8.}, .seed = 1}));
    const auto walls = addTexture(scene, valueNoise({.size = {4., 3.}, .seed = 2}));
    const auto crates = addTexture(scene, valueNoise({.size = {1., 1.}, .seed = 3}));
    addBox(scene, {0., 0., 0.}, {20., 20., 3.}, walls, BoxInside::hollow);
    addPlane(scene, {0., 0., 0.01}, {20., 0., 0.}, {0., 20., 0.}, floor);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> place(0.5, 19.);
    std::uniform_real_distribution<double> size(0.2, 0.8);
    while (scene.triangles.size() < 2292) {
        const Eigen::Vector3d corner(place(random), place(random), 0.);
        addBox(scene, corner, corner + Eigen::Vector3d(size(random), size(random), size(random)),
               crates);
    }
    return scene;
}

/// The straightforward way: one rtcIntersect1 per pixel.
class SingleRays {
  public:
    explicit SingleRays(const Scene& scene)
        : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)), shader_(scene) {
        const std::size_t n = scene.triangles.size();
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* corners = static_cast<float*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * n));
        auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), n));
        for (std::size_t i = 0; i < 3 * n; ++i) {
            Eigen::Map<Eigen::Vector3f>(corners + 3 * i) = scene.triangles[i / 3].corners[i % 3];
            indices[i] = static_cast<unsigned>(i);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    SingleRays(const SingleRays&) = delete;
    SingleRays& operator=(const SingleRays&) = delete;
    ~SingleRays() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }

    void render(const Camera& camera, const Pose& T_c_w, View& view) {
        const Pose T_w_c = T_c_w.inverse();
        const Eigen::Matrix3f R = T_w_c.linear().cast<float>();
        const Eigen::Vector3f origin = T_w_c.translation().cast<float>();
        visible_.resize(camera.width, camera.height);
        view.intensity.resize(camera.height, camera.width);
        view.depth.resize(camera.height, camera.width);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        for (unsigned v = 0; v < camera.height; ++v) {
            for (unsigned u = 0; u < camera.width; ++u) {
                const Eigen::Vector3f ray =
                    R * Eigen::Vector3f(static_cast<float>((u - camera.cx()) / camera.fx()),
                                        static_cast<float>((v - camera.cy()) / camera.fy()), 1.F);
                visible_.row(v)[u] = firstHit(origin, ray, context);
            }
        }
        shader_.shade(camera, T_c_w, visible_, {}, view);
        applyPointSpread(view);
    }

  private:
    std::uint32_t firstHit(const Eigen::Vector3f& origin, const Eigen::Vector3f& ray,
                           RTCIntersectContext& context) const {
        RTCRayHit hit{};
        hit.ray.org_x = origin.x();
        hit.ray.org_y = origin.y();
        hit.ray.org_z = origin.z();
        hit.ray.dir_x = ray.x();
        hit.ray.dir_y = ray.y();
        hit.ray.dir_z = ray.z();
        hit.ray.tfar = std::numeric_limits<float>::infinity();
        hit.ray.mask = ~0U;
        hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        hit.hit.primID = VisibilityImage::kNothing;
        rtcIntersect1(scene_, &context, &hit);
        return hit.hit.primID;
    }

    RTCDevice device_;
    RTCScene scene_;
    SurfaceShader shader_;
    VisibilityImage visible_;
};

/// ViSP's feature needs 8-bit images and one depth for all pixels.
class VispInformation {
  public:
    explicit VispInformation(const Camera& camera) : bytes_(camera.height, camera.width) {
        feature_.init(camera.height, camera.width, 2.);
        vpCameraParameters intrinsics = camera.intrinsics;
        feature_.setCameraParameters(intrinsics);
    }

    double trace(const View& view) {
        for (unsigned i = 0; i < bytes_.getSize(); ++i) {
            bytes_.bitmap[i] = static_cast<unsigned char>(255.F * view.intensity.bitmap[i]);
        }
        feature_.buildFrom(bytes_);
        feature_.interaction(L_);
        Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>> J(
            L_.data, L_.getRows(), 6);
        const Matrix6 information = J.transpose() * J;
        return information.trace();
    }

  private:
    vpImage<unsigned char> bytes_;
    vpFeatureLuminance feature_;
    vpMatrix L_;
};

template <typename Work>
double fastest(int rounds, Work work) {
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < rounds; ++i) {
        const auto start = std::chrono::steady_clock::now();
        work();
        const std::chrono::duration<double, std::micro> took =
            std::chrono::steady_clock::now() - start;
        best = std::min(best, took.count());
    }
    return best;
}

volatile double sink = 0.;

void compare(const char* name, double belowHorizon, const MeshRenderer& renderer,
             SingleRays& singleRays) {
    constexpr int kRounds = 400;
    const Camera camera = makeCamera(188, 120, 70. * std::numbers::pi / 180.);
    const Pose T_w_b(Eigen::Translation3d(10., 10., 2.));
    const Pose T_c_w = (T_w_b * cameraMount(belowHorizon)).inverse();
    View view;
    VispInformation visp(camera);
    const double rays = fastest(kRounds, [&] { singleRays.render(camera, T_c_w, view); });
    const double visps = fastest(kRounds, [&] { sink = visp.trace(view); });
    const double ours = fastest(kRounds, [&] { renderer.render(camera, T_c_w, view); });
    const double info =
        fastest(kRounds, [&] { sink = photometricInformation(view, camera).trace(); });
    const double both = fastest(kRounds, [&] {
        renderer.render(camera, T_c_w, view);
        sink = photometricInformation(view, camera).trace();
    });
    fmt::print(
        "{:<10} single rays {:7.1f} us + ViSP {:6.1f} us | ours {:6.1f} us + {:5.1f} us, "
        "together {:6.1f} us | {:5.1f}x\n",
        name, rays, visps, ours, info, both, (rays + visps) / both);
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv, "mesh_view_bench");
    const Scene scene = hall();
    fmt::print("{} triangles, 188x120, one thread\n", scene.triangles.size());
    const MeshRenderer renderer(scene);
    SingleRays singleRays(scene);
    compare("downward", std::numbers::pi / 2., renderer, singleRays);
    compare("45 degrees", std::numbers::pi / 4., renderer, singleRays);
}
