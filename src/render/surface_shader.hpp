// SPDX-License-Identifier: BSD-3-Clause
// Computes depth and grey value of the visible triangles of a view.
#pragma once

#include <cstdint>
#include <vector>

#include "photometry/view.hpp"
#include "render/mip_texture.hpp"
#include "scene/scene.hpp"

namespace photonav {

/// The index of the triangle visible at each pixel, row by row.
struct VisibilityImage {
    static constexpr std::uint32_t kNothing = 0xffffffffU;

    void resize(unsigned width, unsigned height);

    std::uint32_t* row(unsigned v) { return ids.data() + std::size_t{v} * pitch; }
    const std::uint32_t* row(unsigned v) const { return ids.data() + std::size_t{v} * pitch; }

    unsigned pitch = 0;  ///< entries per row, a vector more than the width; rows in multiples of 4
    std::vector<std::uint32_t> ids;
};

/// A triangle that covers a part of a pixel whose centre shows another one.
struct Covering {
    unsigned x, y;     ///< of the pixel
    std::uint32_t id;  ///< of the triangle
    float share;       ///< of the pixel's area
    float dx, dy;      ///< where to look up its grey value, from the pixel's centre [pixels]
};

/// Those at borders across rows of pixels, and across columns. The shares of a pixel in a row (or
/// column) add up; those of its row and its column multiply, as in the average over a square.
struct Coverings {
    std::vector<Covering> alongRows, alongColumns;
};

/// Evaluates depth and grey value per pixel from the plane of its triangle. Inverse depth and
/// (texture coordinates / depth) are affine in the pixel, with coefficients computed in double
/// precision once per triangle and view. They change more smoothly with the pose than the hit
/// distance of a ray.
///
/// Textures are looked up trilinearly, in 16 bits. The level follows the geometric mean of the
/// pixel's footprint, sqrt(area): on an oblique surface this blurs the far direction a little less
/// and the near direction a little more than an isotropic footprint requires.
class SurfaceShader {
  public:
    /// @param scene must outlive this object
    explicit SurfaceShader(const Scene& scene);

    /// Computes depth and intensity of a view. Pixels without a triangle become 0. Thread-safe.
    /// @param coverings change grey values, and not depths
    /// @param view must have the camera's size
    void shade(const Camera& camera, const Pose& T_c_w, const VisibilityImage& visible,
               const Coverings& coverings, View& view) const;

  private:
    std::vector<MipTexture> textures_;
    const Scene* scene_;
};

}  // namespace photonav
