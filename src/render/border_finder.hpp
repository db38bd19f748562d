// SPDX-License-Identifier: BSD-3-Clause
// Which part of a pixel shows the surface next to the one at its centre.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/camera.hpp"
#include "render/surface_shader.hpp"
#include "scene/scene.hpp"

namespace photonav {

/// A triangle, or the parallelogram that it makes up with another one, whose diagonal is no border.
struct FlatSurface {
    unsigned sides;  ///< 3 or 4
    std::array<Eigen::Vector3f, 4> corners;
    std::uint32_t otherHalf;  ///< the other triangle; VisibilityImage::kNothing: none
};

/// Finds the pixels that the border of two surfaces crosses, and the share of their area that shows
/// the surface on the other side, for SurfaceShader. Without it a border jumps from pixel to pixel
/// when the camera moves: along rows and columns of the image it is up to half a pixel beside its
/// place, over its whole length.
///
/// Where neighbouring pixel centres see different surfaces, the border between them is an edge of
/// the nearer one, or the line at which the two planes meet: straight lines in the image, so that
/// areas follow without sampling (after Persson, "Geometry Buffer Anti-Aliasing", 2011). Each
/// border counts as a line without end: a corner of a surface has up to a quarter of a pixel too
/// much or too little. A surface that is seen from no pixel centre stays unseen, and borders to
/// where nothing is are not blended.
class BorderFinder {
  public:
    /// Meshes of more triangles are left as they are: many of their triangles are smaller than a
    /// pixel, so that their edges are no borders of surfaces. The same for all sizes of images.
    static constexpr std::size_t kMostTriangles = 5000;

    explicit BorderFinder(const std::vector<Triangle>& triangles);

    /// None for cameras without point spread, whose pixels are single rays.
    /// @param visible from pixel centres
    /// @param coverings overwritten
    void find(const Camera& camera, const Pose& T_c_w, const VisibilityImage& visible,
              Coverings& coverings) const;

  private:
    std::vector<FlatSurface> surfaces_;  ///< by triangle; none: too many
};

}  // namespace photonav
