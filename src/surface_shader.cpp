// SPDX-License-Identifier: BSD-3-Clause
#include "surface_shader.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "simd.hpp"

namespace photonav {
namespace {

using simd::bits;
using simd::Float;
using simd::Int;
using simd::kWidth;
using simd::rounded;
using simd::splat;
using simd::toFloat;
using simd::toInt;

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
        const double uScale = double{levels[k].width} / levels[0].width;
        const double vScale = double{levels[k].height} / levels[0].height;
        const double u = texelAtCamera.x() * uScale - 0.5;
        const double v = texelAtCamera.y() * vScale - 0.5;
        const auto whole = [](double x, double n) { return std::floor(x) - n * std::floor(x / n); };
        const double uWhole = whole(u, levels[k].width);
        const double vWhole = whole(v, levels[k].height);
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

    if (texture.uniform()) return;

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

/// i modulo n for whole numbers.
[[gnu::always_inline]] inline Float wrapped(Float i, float n, float inverse) {
    return i - n * rounded((i + 0.5F) * inverse - 0.5F);
}

/// The 16-bit halves of 32 bits.
struct Halves {
    Float low, high;
    explicit Halves(Int bits) : low(toFloat(bits & 0xffff)), high(toFloat((bits >> 16) & 0xffff)) {}
};

using Quads [[gnu::vector_size(kWidth * 4)]] = std::int64_t;

/// The entries for lanes 0 and 1 (plus `shift`) of each block of four.
template <int shift, std::size_t... i>
[[gnu::always_inline]] inline Quads gathered(const std::uint64_t* quads, Int index,
                                             std::index_sequence<i...> /*lanes*/) {
    return Quads{static_cast<std::int64_t>(quads[index[i / 2 * 4 + i % 2 + shift]])...};
}

/// A texture's grey values, times MipTexture::kOne, at one pyramid level.
[[gnu::always_inline]] inline Float bilinear(const MipTexture& texture, std::size_t level,
                                             const Surface::Level& origin, Float u, Float v) {
    const MipTexture::Level& image = texture.levels()[level];
    const Float x = u * origin.uScale + origin.uPart;
    const Float y = v * origin.vScale + origin.vPart;
    const Float column = rounded(x - 0.5F);  // floor, or one less with x - column = 1: the same
    const Float row = rounded(y - 0.5F);
    const Int index =
        toInt(wrapped(row + origin.vWhole, image.height, image.inverseHeight)) * image.pitch +
        toInt(wrapped(column + origin.uWhole, image.width, image.inverseWidth));

    // In each block of four lanes two go to either vector, so that upper and lower texels come
    // apart by one shuffle within the block.
    const std::uint64_t* quads = texture.quads(level);
    const auto half = std::make_index_sequence<kWidth / 2>{};
    const auto first = std::bit_cast<Int>(gathered<0>(quads, index, half));
    const auto second = std::bit_cast<Int>(gathered<2>(quads, index, half));
    Int even{};
    for (int i = 0; i < kWidth; ++i) even[i] = i / 4 * 4 + i % 2 * 2 + (i % 4 / 2) * kWidth;
    const Halves above(__builtin_shuffle(first, second, even));
    const Halves below(__builtin_shuffle(first, second, even + 1));
    const Float s = x - column;
    const Float top = above.low + (above.high - above.low) * s;
    const Float bottom = below.low + (below.high - below.low) * s;
    return top + (bottom - top) * (y - row);
}

/// log2 by exponent and mantissa: exact at powers of two, linear between, continuous.
Float roughLog2(Float x) {
    const Int bits = std::bit_cast<Int>(x);
    return toFloat(bits) * (1.F / (1 << 23)) - 127.F;
}

/// @param active bits of the lanes that count
Float trilinear(const Surface& surface, Float z, Float u, Float v, unsigned active) {
    const MipTexture& texture = *surface.texture;
    const std::size_t count = texture.levels().size();
    const auto coarsest = static_cast<float>(count - 1);
    const Float level = simd::clamp(0.5F * roughLog2(surface.footprint * z * z * z), 0.F, coarsest);
    const Int whole = toInt(level);
    const Float part = level - toFloat(whole);

    Float grey{};
    for (unsigned todo = active; todo != 0;) {
        const auto k = static_cast<std::size_t>(whole[std::countr_zero(todo)]);
        const Int here = whole == static_cast<int>(k);
        const std::size_t next = std::min(k + 1, count - 1);
        const Float fine = bilinear(texture, k, surface.levels[k], u, v);
        const Float coarse = bilinear(texture, next, surface.levels[next], u, v);
        grey = here ? fine + (coarse - fine) * part : grey;
        todo &= ~bits(here);
    }
    return grey * (1.F / MipTexture::kOne);
}

/// The pixels of a strip that see one triangle.
void shadeStrip(const Surface& surface, Float x, float y, Int active, Float& depth, Float& grey) {
    if (surface.edgeOn) return;
    const Float z =
        1.F / simd::clamp(surface.inverseDepth(x, y), surface.farthest, surface.nearest);
    depth = active ? z : depth;
    if (const auto uniform = surface.texture->uniform()) {
        grey = active ? splat(*uniform) : grey;
        return;
    }
    const Float u = surface.u(x, y) * z;
    const Float v = surface.v(x, y) * z;
    grey = active ? trilinear(surface, z, u, v, bits(active)) : grey;
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
    const Float lane = simd::ramp();
    for (unsigned y = 0; y < camera.height; ++y) {
        const std::uint32_t* ids = visible.row(y);
        for (unsigned x = 0; x < camera.width; x += kWidth) {
            const unsigned count = std::min<unsigned>(kWidth, camera.width - x);
            const Int id = simd::load<Int>(ids + x);
            unsigned todo = bits(id != static_cast<int>(VisibilityImage::kNothing)) &
                            (simd::kAllLanes >> (kWidth - count));
            Float depth{};
            Float grey{};
            while (todo != 0) {
                const int first = id[std::countr_zero(todo)];
                const Int active = id == first;
                shadeStrip(surfaces[static_cast<std::uint32_t>(first)],
                           lane + static_cast<float>(x), static_cast<float>(y), active, depth,
                           grey);
                todo &= ~bits(active);
            }
            if (count == kWidth) {
                simd::store(view.depth[y] + x, depth);
                simd::store(view.intensity[y] + x, grey);
            } else {
                std::memcpy(view.depth[y] + x, &depth, count * sizeof(float));
                std::memcpy(view.intensity[y] + x, &grey, count * sizeof(float));
            }
        }
    }
}

}  // namespace photonav
