// SPDX-License-Identifier: BSD-3-Clause
#include "render/surface_shader.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <span>
#include <utility>

#include "photometry/simd.hpp"
#include "render/image_function.hpp"
#include "render/triangle_cache.hpp"

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

/// Area of texture over which a pixel is assumed to average, relative to its footprint. Pyramid
/// levels and interpolation blur as well; with this value the result is closest to the average over
/// the pixel (measured for texels from a third of a pixel to two pixels: half the error that 1
/// gives).
constexpr double kFootprint = 0.6;

constexpr int kMaxLevels = 17;  // a texture has at most 32768 texels along a side

/// An ImageFunction in single precision.
struct Affine {
    float a, b, c;
    Affine() = default;
    explicit Affine(const ImageFunction& f)
        : a(static_cast<float>(f.a)), b(static_cast<float>(f.b)), c(static_cast<float>(f.c)) {}
    template <typename Y>  // float or Float
    Float operator()(Float x, Y y) const {
        return a * x + (b * y + c);
    }
};

/// What one triangle looks like from one camera.
struct Surface {
    bool edgeOn = false;      ///< the camera lies in its plane: nothing to see
    float nearest, farthest;  ///< bounds of the inverse depth over the corners [1/m]
    Affine inverseDepth;      ///< [1/m]
    Affine u, v;              ///< (texel coordinate - its value at the camera) / depth [1/m]
    float footprint;          ///< texels^2 per pixel, times depth^3
    const MipTexture* texture;
    Eigen::Array2d texelAtCamera;  ///< texel coordinate at the camera
    /// Per pyramid level: scale of texel coordinates, and the texel coordinate at the camera split
    /// into a whole and a fractional part, so that nothing is lost far from the texture's origin.
    struct Level {
        float uScale, vScale, uWhole, vWhole, uPart, vPart;
    };
    std::array<Level, kMaxLevels> levels;
};

/// Prepares the levels that depths between the corners can ask for.
void setLevels(Surface& surface, const Eigen::Vector2d& texelAtCamera) {
    const auto& levels = surface.texture->levels();
    const auto coarsest = static_cast<double>(levels.size() - 1);
    const auto levelAt = [&](double inverseDepth) {
        return 0.5 * std::log2(surface.footprint / std::pow(inverseDepth, 3));
    };
    const auto first =
        static_cast<std::size_t>(std::clamp(levelAt(surface.nearest) - 0.1, 0., coarsest));
    const auto last =  // at least 1: level 0 is blended with the next one whatever the weight
        static_cast<std::size_t>(std::clamp(levelAt(surface.farthest) + 1.1, 1., coarsest));
    for (std::size_t k = first; k <= last; ++k) {
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
    surface.inverseDepth = Affine(inPixels(normal / distance, camera));

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
    surface.u = Affine(inPixels(uGradient, camera));
    surface.v = Affine(inPixels(vGradient, camera));

    // The map pixel -> texel is projective, H / inverse depth: its area factor is
    // det H / (inverse depth)^3, and det H = normal . (uGradient x vGradient) / distance / (fx fy).
    surface.footprint = static_cast<float>(
        kFootprint * std::abs(normal.dot(uGradient.cross(vGradient)) / distance) /
        (camera.fx() * camera.fy()));
    const Eigen::Vector2d texelAtCamera =
        texel(0) - Eigen::Vector2d(uGradient.dot(p[0]), vGradient.dot(p[0]));
    surface.texelAtCamera = texelAtCamera.array();
    setLevels(surface, texelAtCamera);
}

/// The surfaces of a view.
class SurfaceCache {
  public:
    SurfaceCache(const Scene& scene, const std::vector<MipTexture>& textures, const Camera& camera,
                 const Pose& T_c_w)
        : scene_(scene), textures_(textures), camera_(camera), T_c_w_(T_c_w) {}

    const Surface& operator[](std::uint32_t id) {
        return surfaces_.get(id, [&](Surface& surface) {
            const Triangle& triangle = scene_.triangles[id];
            setUp(surface, triangle, textures_[triangle.texture], camera_, T_c_w_);
        });
    }

  private:
    const Scene& scene_;
    const std::vector<MipTexture>& textures_;
    const Camera& camera_;
    const Pose& T_c_w_;
    TriangleCache<Surface> surfaces_;
};

/// i modulo n for whole numbers; within [0, n) whatever i is.
[[gnu::always_inline]] inline Float wrapped(Float i, float n, float inverse) {
    return simd::clamp(i - n * rounded((i + 0.5F) * inverse - 0.5F), 0.F, n - 1.F);
}

/// The 16-bit halves of 32 bits.
struct Halves {
    Float low, high;
    explicit Halves(Int bits) : low(toFloat(bits & 0xffff)), high(toFloat((bits >> 16) & 0xffff)) {}
};

/// A texture's grey values, times MipTexture::kOne, at one pyramid level.
[[gnu::always_inline]] inline Float bilinear(const MipTexture& texture, std::size_t level,
                                             const Surface::Level& origin, Float u, Float v) {
    const MipTexture::Level& image = texture.levels()[level];
    const std::uint16_t* texels = texture.texels(level);
    const Float x = u * origin.uScale + origin.uPart;
    const Float column = rounded(x - 0.5F);  // floor, or one less with x - column = 1: the same
    const Float s = x - column;
    const Int across = toInt(wrapped(column + origin.uWhole, image.width, image.inverseWidth));
    const auto between = [s](const std::uint16_t* row, Int index) {
        // A texel and its right neighbour are 32 bits in one piece.
        const Halves pair(simd::gather<sizeof(*row)>(row, index));
        return pair.low + (pair.high - pair.low) * s;
    };
    if (image.height == 1.F) return between(texels, across);  // stripes: rows are alike

    const Float y = v * origin.vScale + origin.vPart;
    const Float row = rounded(y - 0.5F);
    const Int index =
        toInt(wrapped(row + origin.vWhole, image.height, image.inverseHeight)) * image.pitch +
        across;
    const Float top = between(texels, index);
    const Float bottom = between(texels + image.pitch, index);
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

/// Depth and grey value of one row's pixels.
struct PixelRow {
    float* depth;
    float* grey;

    /// Writes kWidth pixels from x, but not beyond the row. Pixels to the right of the run are
    /// overwritten later.
    void store(unsigned x, unsigned width, Float z, Float intensity) const {
        if (x + kWidth <= width) {
            simd::store(depth + x, z);
            simd::store(grey + x, intensity);
        } else {
            std::memcpy(depth + x, &z, (width - x) * sizeof(float));
            std::memcpy(grey + x, &intensity, (width - x) * sizeof(float));
        }
    }
};

/// The grey value of pixels [begin, end) of row y if their lookups find no other one. The texel
/// coordinates along a row are between those at its ends, and so are the levels.
std::optional<float> uniformGrey(const Surface& surface, unsigned begin, unsigned end, float y) {
    const MipTexture& texture = *surface.texture;
    if (texture.uniform() || surface.edgeOn) return texture.uniform();
    if (!texture.hasUniformTiles()) return {};
    double farthest = 0.;
    Eigen::AlignedBox2d box;
    for (const unsigned x : {begin, end - 1}) {
        const auto at = [&](const Affine& f) { return double{f.a} * x + double{f.b} * y + f.c; };
        const double w =
            std::clamp<double>(at(surface.inverseDepth), surface.farthest, surface.nearest);
        box.extend(
            (surface.texelAtCamera + Eigen::Array2d(at(surface.u), at(surface.v)) / w).matrix());
        farthest = std::max(farthest, 1. / w);
    }
    // Texels of the coarser level are up to 2^(level + 1) wide; one and a half of them matter.
    const double finest = std::sqrt(surface.footprint * farthest * farthest * farthest);
    const double margin = 4. * std::max(1., finest) + 2.;
    const auto texel =
        texture.uniformWithin(box.min().array() - margin, box.max().array() + margin);
    if (!texel) return {};
    return static_cast<float>(*texel) * (1.F / MipTexture::kOne);
}

/// Pixels [begin, end) of row y, which all show the same surface.
void shadePart(const Surface& surface, unsigned begin, unsigned end, unsigned width, unsigned row,
               const PixelRow& pixels) {
    const auto y = static_cast<float>(row);
    const auto uniform = uniformGrey(surface, begin, end, y);
    for (unsigned x = begin; x < end; x += kWidth) {
        if (surface.edgeOn) {
            pixels.store(x, width, Float{}, Float{});
            continue;
        }
        const Float column = simd::ramp() + static_cast<float>(x);
        const Float w = surface.inverseDepth(column, y);
        const Float z = 1.F / simd::clamp(w, surface.farthest, surface.nearest);
        if (uniform) {
            pixels.store(x, width, z, splat(*uniform));
            continue;
        }
        const Float u = surface.u(column, y) * z;
        const Float v = surface.v(column, y) * z;
        const unsigned active = simd::kAllLanes >> (kWidth - std::min<unsigned>(kWidth, end - x));
        pixels.store(x, width, z, trilinear(surface, z, u, v, active));
    }
}

/// The same for a run of any length. Parts are short enough to be within a uniform area.
void shadeRun(const Surface& surface, unsigned begin, unsigned end, unsigned width, unsigned row,
              const PixelRow& pixels) {
    constexpr unsigned kPart = 64;
    for (; begin < end; begin += kPart) {
        shadePart(surface, begin, std::min(end, begin + kPart), width, row, pixels);
    }
}

/// Grey values of a surface's plane at up to kWidth pixels.
Float greysAt(const Surface& surface, Float x, Float y, unsigned count) {
    if (const auto uniform = surface.texture->uniform()) return splat(*uniform);
    const Float w = surface.inverseDepth(x, y);
    const Float z = 1.F / simd::clamp(w, surface.farthest, surface.nearest);
    const unsigned active = simd::kAllLanes >> (kWidth - count);
    return trilinear(surface, z, surface.u(x, y) * z, surface.v(x, y) * z, active);
}

/// Indices of coverings, those of the same slot of the cache one after the other.
void groupBySlot(std::span<const Covering> coverings, std::vector<unsigned>& grouped) {
    using Cache = TriangleCache<Surface>;
    std::array<unsigned, Cache::kSlots + 1> begin{};
    for (const Covering& covering : coverings) ++begin[Cache::slotOf(covering.id) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    grouped.resize(coverings.size());
    for (unsigned i = 0; i < coverings.size(); ++i) {
        grouped[begin[Cache::slotOf(coverings[i].id)]++] = i;
    }
}

/// Adds the shares of pixels that other triangles cover. The grey values of each triangle are
/// looked up together.
void cover(SurfaceCache& surfaces, std::span<const Covering> coverings, ImageF& intensity) {
    thread_local std::vector<unsigned> order;  // spare allocations per view
    thread_local std::vector<float> changes;
    groupBySlot(coverings, order);
    changes.resize(coverings.size());
    for (std::size_t begin = 0; begin < order.size();) {
        const std::uint32_t id = coverings[order[begin]].id;
        Float x{}, y{};
        unsigned count = 0;
        for (; count < kWidth && begin + count < order.size(); ++count) {
            const Covering& covering = coverings[order[begin + count]];
            if (covering.id != id) break;
            x[count] = static_cast<float>(covering.x) + covering.dx;
            y[count] = static_cast<float>(covering.y) + covering.dy;
        }
        const Surface& surface = surfaces[id];
        const Float greys = surface.edgeOn ? Float{} : greysAt(surface, x, y, count);
        for (unsigned i = 0; i < count; ++i) {
            const Covering& covering = coverings[order[begin + i]];
            const float share = surface.edgeOn ? 0.F : covering.share;
            changes[order[begin + i]] = share * (greys[i] - intensity[covering.y][covering.x]);
        }
        begin += count;
    }
    for (std::size_t i = 0; i < coverings.size(); ++i) {
        intensity[coverings[i].y][coverings[i].x] += changes[i];
    }
}

/// End of the run of pixels that show the same triangle as pixel `begin`.
unsigned endOfRun(const std::uint32_t* ids, unsigned begin, unsigned width) {
    const auto first = static_cast<int>(ids[begin]);
    for (unsigned x = begin; x < width; x += kWidth) {
        const auto other = bits(simd::load<Int>(ids + x) != first);
        if (other != 0) return std::min<unsigned>(width, x + std::countr_zero(other));
    }
    return width;
}

}  // namespace

void VisibilityImage::resize(unsigned width, unsigned height) {
    constexpr unsigned kMaxLanes = 16;
    pitch = (width + 2U * kMaxLanes - 1U) / kMaxLanes * kMaxLanes;
    ids.resize(pitch * ((std::size_t{height} + 3U) / 4U * 4U));
}

SurfaceShader::SurfaceShader(const Scene& scene) : scene_(&scene) {
    textures_.reserve(scene.textures.size());
    for (const Texture& texture : scene.textures) textures_.emplace_back(texture.image);
}

void SurfaceShader::shade(const Camera& camera, const Pose& T_c_w, const VisibilityImage& visible,
                          const Coverings& coverings, View& view) const {
    SurfaceCache surfaces(*scene_, textures_, camera, T_c_w);
    for (unsigned y = 0; y < camera.height; ++y) {
        const std::uint32_t* ids = visible.row(y);
        const PixelRow pixels{view.depth[y], view.intensity[y]};
        for (unsigned begin = 0; begin < camera.width;) {
            const unsigned end = endOfRun(ids, begin, camera.width);
            if (ids[begin] == VisibilityImage::kNothing) {
                std::fill(pixels.depth + begin, pixels.depth + end, 0.F);
                std::fill(pixels.grey + begin, pixels.grey + end, 0.F);
            } else {
                shadeRun(surfaces[ids[begin]], begin, end, camera.width, y, pixels);
            }
            begin = end;
        }
    }
    cover(surfaces, coverings.alongRows, view.intensity);
    cover(surfaces, coverings.alongColumns, view.intensity);
}

}  // namespace photonav
