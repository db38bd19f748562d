// SPDX-License-Identifier: BSD-3-Clause
#include "render/mesh_renderer.hpp"

#include <embree3/rtcore.h>

#include <limits>
#include <memory>
#include <new>
#include <stdexcept>

#include "photometry/simd.hpp"
#include "render/border_finder.hpp"
#include "render/rasterizer.hpp"
#include "render/surface_shader.hpp"

namespace photonav {
namespace {

using simd::kWidth;

/// Ray packets cover tiles of 4 columns.
constexpr unsigned kTileWidth = 4;
constexpr unsigned kTileHeight = kWidth / kTileWidth;

#if defined(__AVX512F__)
using RayPacket = RTCRayHit16;
constexpr auto intersect = rtcIntersect16;
#elif defined(__AVX2__)
using RayPacket = RTCRayHit8;
constexpr auto intersect = rtcIntersect8;
#else
using RayPacket = RTCRayHit4;
constexpr auto intersect = rtcIntersect4;
#endif

/// With at least so many pixels per triangle of the scene, rasterizing beats ray packets.
constexpr std::size_t kPixelsPerTriangle = 4;

struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};

/// What Embree has made. @throws std::bad_alloc for null
template <typename Made>
Made made(Made object) {
    if (object == nullptr) throw std::bad_alloc();
    return object;
}

/// Embree's bounding volume hierarchy over the triangles.
class RayCaster {
  public:
    explicit RayCaster(const std::vector<Triangle>& triangles)
        : device_(made(rtcNewDevice(nullptr))), scene_(made(rtcNewScene(device_.get()))) {
        const std::size_t n = triangles.size();
        const std::unique_ptr<RTCGeometryTy, Release> geometry(
            made(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE)));
        auto* corners = static_cast<float*>(
            made(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0,
                                         RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * n)));
        auto* indices = static_cast<unsigned*>(made(rtcSetNewGeometryBuffer(
            geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), n)));
        for (std::size_t i = 0; i < 3 * n; ++i) {
            Eigen::Map<Eigen::Vector3f>(corners + 3 * i) = triangles[i / 3].corners[i % 3];
            indices[i] = static_cast<unsigned>(i);
        }
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometry(scene_.get(), geometry.get());
        // Robust: rays through an edge shared by two triangles must not slip between them.
        rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(scene_.get());
        const RTCError error = rtcGetDeviceError(device_.get());
        if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
        if (error != RTC_ERROR_NONE) throw std::runtime_error("Embree cannot build the scene");
    }

    void cast(const Camera& camera, const Pose& T_c_w, VisibilityImage& visible) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        const Pose T_w_c = T_c_w.inverse();
        for (unsigned y = 0; y < camera.height; y += kTileHeight) {
            for (unsigned x = 0; x < camera.width; x += kTileWidth) {
                castTile(camera, T_w_c, x, y, context, visible);
            }
        }
    }

  private:
    void castTile(const Camera& camera, const Pose& T_w_c, unsigned x0, unsigned y0,
                  RTCIntersectContext& context, VisibilityImage& visible) const {
        alignas(64) std::array<int, kWidth> valid;
        alignas(64) RayPacket packet;
        const Eigen::Matrix3f R = T_w_c.linear().cast<float>();
        const Eigen::Vector3f origin = T_w_c.translation().cast<float>();
        for (unsigned i = 0; i < kWidth; ++i) {
            const unsigned u = x0 + i % kTileWidth;
            const unsigned v = y0 + i / kTileWidth;
            valid[i] = u < camera.width && v < camera.height ? -1 : 0;
            const Eigen::Vector3f ray = R * camera.unproject(u, v).cast<float>();
            packet.ray.org_x[i] = origin.x();
            packet.ray.org_y[i] = origin.y();
            packet.ray.org_z[i] = origin.z();
            packet.ray.dir_x[i] = ray.x();
            packet.ray.dir_y[i] = ray.y();
            packet.ray.dir_z[i] = ray.z();
            packet.ray.tnear[i] = 0.F;
            packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
            packet.ray.time[i] = 0.F;
            packet.ray.mask[i] = ~0U;
            packet.ray.flags[i] = 0U;
            packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
            packet.hit.primID[i] = VisibilityImage::kNothing;
            packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        }
        intersect(valid.data(), scene_.get(), &context, &packet);
        for (unsigned row = 0; row < kTileHeight; ++row) {
            std::memcpy(visible.row(y0 + row) + x0,
                        packet.hit.primID + std::size_t{row} * kTileWidth,
                        kTileWidth * sizeof(std::uint32_t));
        }
    }

    std::unique_ptr<RTCDeviceTy, Release> device_;
    std::unique_ptr<RTCSceneTy, Release> scene_;
};

}  // namespace

struct MeshRenderer::Impl {
    explicit Impl(Scene input)
        : scene(std::move(input)),
          caster(scene.triangles),
          rasterizer(scene.triangles),
          borders(scene.triangles),
          shader(scene) {}

    Scene scene;
    RayCaster caster;
    Rasterizer rasterizer;
    BorderFinder borders;
    SurfaceShader shader;
};

MeshRenderer::MeshRenderer(Scene scene) : impl_(std::make_unique<Impl>(std::move(scene))) {}
MeshRenderer::~MeshRenderer() = default;
MeshRenderer::MeshRenderer(MeshRenderer&&) noexcept = default;
MeshRenderer& MeshRenderer::operator=(MeshRenderer&&) noexcept = default;

const Scene& MeshRenderer::scene() const { return impl_->scene; }

void MeshRenderer::render(const Camera& camera, const Pose& T_c_w, View& view) const {
    thread_local VisibilityImage visible;  // spares an allocation per view
    visible.resize(camera.width, camera.height);
    view.intensity.resize(camera.height, camera.width);
    view.depth.resize(camera.height, camera.width);
    if (impl_->scene.triangles.size() * kPixelsPerTriangle <=
        std::size_t{camera.width} * camera.height) {
        impl_->rasterizer.rasterize(camera, T_c_w, visible);
    } else {
        impl_->caster.cast(camera, T_c_w, visible);
    }
    thread_local Coverings coverings;
    impl_->borders.find(camera, T_c_w, visible, coverings);
    impl_->shader.shade(camera, T_c_w, visible, coverings, view);
    if (camera.hasPointSpread) applyPointSpread(view);
}

}  // namespace photonav
