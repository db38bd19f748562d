// SPDX-License-Identifier: BSD-3-Clause
#include "surface_shader.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "simd.hpp"

namespace photonav {
namespace {

using simd::Float;
using simd::Int;
using simd::kWidth;

constexpr int kMostLevels = 17;  // a texture has at most 32768 texels along a side

/// a x + b y + c over the image, x and y in pixels.
struct Affine {
    float a, b, c;
    Float operator()(Float x, float y) const { return a * x + (b * y + c); }
};

/// What one triangle looks like from one camera.
struct Surface {
    std::uint32_t id = VisibilityImage::kNothing;
    bool edgeOn = false;      ///< the camera lies in its plane: nothing to see
    float nearest, farthest;  ///< bounds of the inverse depth over the corners [1/m]
    Affine inverseDepth;      ///< [1/m]
    Affine u, v;              ///< (texel coordinate - its value at the camera) / depth [1/m]
    float footprint;          ///< texels^2 per pixel, times depth^3
    const MipTexture* texture;
    /// Per pyramid level: scale of texel coordinates, and the texel coordinate at the camera split
    /// into a whole and a fractional part, so that nothing is lost far from the texture's origin.
    struct Level {
        float uScale, vScale, uWhole, vWhole, uPart, vPart;
    };
    std::array<Level, kMostLevels> levels;
};

Affine affineInPixels(const Eigen::Vector3d& perRay, const Camera& camera) {
    const double a = perRay.x() / camera.fx();
    const double b = perRay.y() / camera.fy();
    return {static_cast<float>(a), static_cast<float>(b),
            static_cast<float>(perRay.z() - a * camera.cx() - b * camera.cy())};
}

void setLevels(Surface& surface, const Eigen::Vector2d& texelAtCamera) {
    const auto& levels = surface.texture->levels();
    for (std::size_t k = 0; k < levels.size(); ++k) {
        const double uScale = static_cast<double>(levels[k].width) / levels[0].width;
        const double vScale = static_cast<double>(levels[k].height) / levels[0].height;
        const double u = texelAtCamera.x() * uScale - 0.5;
        const double v = texelAtCamera.y() * vScale - 0.5;
        const double uWhole = std::fmod(std::floor(u), levels[k].width);
        const double vWhole = std::fmod(std::floor(v), levels[k].height);
        surface.levels[k] = {static_cast<float>(uScale),
                             static_cast<float>(vScale),
                             static_cast<float>(uWhole),
                             static_cast<float>(vWhole),
                             static_cast<float>(u - std::floor(u)),
                             static_cast<float>(v - std::floor(v))};
    }
}

void setUp(Surface& surface, const Triangle& triangle, const MipTexture& texture,
           const Camera& camera, const Pose& T_c_w) {
    std::array<Eigen::Vector3d, 3> p;
    for (int i = 0; i < 3; ++i) p[i] = T_c_w * triangle.corners[i].cast<double>();
    const Eigen::Vector3d a = p[1] - p[0];
    const Eigen::Vector3d b = p[2] - p[0];
    const Eigen::Vector3d normal = a.cross(b);
    const double distance = normal.dot(p[0]);  // times the normal's length
    surface.texture = &texture;
    surface.edgeOn = std::abs(distance) < 1e-9 * normal.norm();
    if (surface.edgeOn) return;

    const double smallest = std::min({p[0].z(), p[1].z(), p[2].z()});
    const double largest = std::max({p[0].z(), p[1].z(), p[2].z()});
    surface.nearest = smallest > 1e-6 ? static_cast<float>(1. / smallest) : 1e6F;
    surface.farthest = largest > 1e-6 ? static_cast<float>(1. / largest) : 1e6F;
    surface.inverseDepth = affineInPixels(normal / distance, camera);

    // Texel coordinates are linear in the point: gradients from the values at the corners.
    const Eigen::Vector3d alongA = b.cross(normal) / normal.squaredNorm();
    const Eigen::Vector3d alongB = normal.cross(a) / normal.squaredNorm();
    const auto& base = texture.levels()[0];
    const auto texel = [&](int i) -> Eigen::Vector2d {
        return triangle.uv[i].cast<double>().cwiseProduct(Eigen::Vector2d(base.width, base.height));
    };
    const Eigen::Vector2d stepA = texel(1) - texel(0);
    const Eigen::Vector2d stepB = texel(2) - texel(0);
    const Eigen::Vector3d uGradient = stepA.x() * alongA + stepB.x() * alongB;
    const Eigen::Vector3d vGradient = stepA.y() * alongA + stepB.y() * alongB;
    surface.u = affineInPixels(uGradient, camera);
    surface.v = affineInPixels(vGradient, camera);
    setLevels(surface, texel(0) - Eigen::Vector2d(uGradient.dot(p[0]), vGradient.dot(p[0])));

    // The map pixel -> texel is projective, H / inverse depth: its area factor is
    // det H / (inverse depth)^3, and det H = normal . (uGradient x vGradient) / distance / (fx fy).
    surface.footprint = static_cast<float>(
        std::abs(normal.dot(uGradient.cross(vGradient)) / distance) / (camera.fx() * camera.fy()));
}

/// The surfaces met so far in this view; a triangle that maps to a taken place replaces it.
class SurfaceCache {
  public:
    SurfaceCache(const Scene& scene, const std::vector<MipTexture>& textures, const Camera& camera,
                 const Pose& T_c_w)
        : scene_(scene), textures_(textures), camera_(camera), T_c_w_(T_c_w) {}

    const Surface& operator[](std::uint32_t id) {
        Surface& surface = surfaces_[id % surfaces_.size()];
        if (surface.id != id) {
            const Triangle& triangle = scene_.triangles[id];
            surface.id = id;
            setUp(surface, triangle, textures_[triangle.texture], camera_, T_c_w_);
        }
        return surface;
    }

  private:
    const Scene& scene_;
    const std::vector<MipTexture>& textures_;
    const Camera& camera_;
    const Pose& T_c_w_;
    std::array<Surface, 256> surfaces_;
};

Float splat(float x) { return Float{} + x; }
Float toFloat(Int x) { return __builtin_convertvector(x, Float); }

Float floorOf(Float x) {
    const Float truncated = toFloat(__builtin_convertvector(x, Int));
    return truncated > x ? truncated - 1.F : truncated;
}

Float wrapped(Float i, int n) {
    const auto size = static_cast<float>(n);
    return i - size * floorOf((i + 0.5F) * (1.F / size));
}

Float bilinear(const Surface& surface, std::size_t level, Float u, Float v) {
    const MipTexture::Level& image = surface.texture->levels()[level];
    const Surface::Level& origin = surface.levels[level];
    const Float x = u * origin.uScale + origin.uPart;
    const Float y = v * origin.vScale + origin.vPart;
    const Float column = floorOf(x);
    const Float row = floorOf(y);
    const Int index =
        __builtin_convertvector(wrapped(row + origin.vWhole, image.height), Int) * image.pitch +
        __builtin_convertvector(wrapped(column + origin.uWhole, image.width), Int);
    const float* texels = surface.texture->texels(level);
    Float a, b, c, d;
    for (int i = 0; i < kWidth; ++i) {
        const float* texel = texels + index[i];
        a[i] = texel[0];
        b[i] = texel[1];
        c[i] = texel[image.pitch];
        d[i] = texel[image.pitch + 1];
    }
    const Float s = x - column;
    const Float above = a + (b - a) * s;
    const Float below = c + (d - c) * s;
    return above + (below - above) * (y - row);
}

/// log2 by exponent and mantissa: exact at powers of two, linear between, continuous.
Float roughLog2(Float x) {
    const Int bits = std::bit_cast<Int>(x);
    return toFloat(bits) * (1.F / (1 << 23)) - 127.F;
}

Float trilinear(const Surface& surface, Float z, Float u, Float v, Int active) {
    const std::size_t count = surface.texture->levels().size();
    if (count == 1) return splat(*surface.texture->texels(0));
    const auto coarsest = static_cast<float>(count - 1);
    Float level = 0.5F * roughLog2(surface.footprint * z * z * z);
    level = level < 0.F ? Float{} : level;
    level = level > coarsest ? splat(coarsest) : level;
    const Int whole = __builtin_convertvector(level, Int);
    const Float part = level - toFloat(whole);

    int first = static_cast<int>(count) - 1;
    int last = 0;
    for (int i = 0; i < kWidth; ++i) {
        if (!active[i]) continue;
        first = std::min(first, whole[i]);
        last = std::max(last, whole[i]);
    }
    Float grey{};
    for (int k = first; k <= last; ++k) {
        const Float fine = bilinear(surface, k, u, v);
        const std::size_t next = std::min<std::size_t>(k + 1, count - 1);
        const Float coarse = bilinear(surface, next, u, v);
        grey = whole == k ? fine + (coarse - fine) * part : grey;
    }
    return grey;
}

Float clamped(Float x, float low, float high) {
    x = x < low ? splat(low) : x;
    return x > high ? splat(high) : x;
}

/// The pixels of a strip that see one triangle.
void shadeStrip(const Surface& surface, Float x, float y, Int active, Float& depth, Float& grey) {
    if (surface.edgeOn) return;
    const Float z = 1.F / clamped(surface.inverseDepth(x, y), surface.farthest, surface.nearest);
    const Float u = surface.u(x, y) * z;
    const Float v = surface.v(x, y) * z;
    depth = active ? z : depth;
    grey = active ? trilinear(surface, z, u, v, active) : grey;
}

Int firstLanes(unsigned count) {
    Int mask{};
    for (int i = 0; i < kWidth; ++i) mask[i] = static_cast<unsigned>(i) < count ? -1 : 0;
    return mask;
}

int firstActive(Int mask) {
    for (int i = 0; i < kWidth; ++i) {
        if (mask[i]) return i;
    }
    return -1;
}

}  // namespace

void VisibilityImage::resize(unsigned width, unsigned height) {
    pitch = (width + 15U) / 16U * 16U;
    ids.resize(std::size_t{pitch} * ((height + 3U) / 4U * 4U));
}

SurfaceShader::SurfaceShader(const Scene& scene) : scene_(&scene) {
    textures_.reserve(scene.textures.size());
    for (const Texture& texture : scene.textures) textures_.emplace_back(texture.image);
}

void SurfaceShader::shade(const Camera& camera, const Pose& T_c_w, const VisibilityImage& visible,
                          View& view) const {
    SurfaceCache surfaces(*scene_, textures_, camera, T_c_w);
    Float lane{};
    for (int i = 0; i < kWidth; ++i) lane[i] = static_cast<float>(i);
    for (unsigned y = 0; y < camera.height; ++y) {
        const std::uint32_t* ids = visible.row(y);
        for (unsigned x = 0; x < camera.width; x += kWidth) {
            const unsigned count = std::min<unsigned>(kWidth, camera.width - x);
            Int id;
            std::memcpy(&id, ids + x, sizeof(id));
            Int todo = firstLanes(count) & (id != static_cast<int>(VisibilityImage::kNothing));
            Float depth{};
            Float grey{};
            for (int i = firstActive(todo); i >= 0; i = firstActive(todo)) {
                const Int active = todo & (id == id[i]);
                shadeStrip(surfaces[static_cast<std::uint32_t>(id[i])],
                           lane + static_cast<float>(x), static_cast<float>(y), active, depth,
                           grey);
                todo &= ~active;
            }
            std::memcpy(view.depth[y] + x, &depth, count * sizeof(float));
            std::memcpy(view.intensity[y] + x, &grey, count * sizeof(float));
        }
    }
}

}  // namespace photonav
