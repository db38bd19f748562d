// SPDX-License-Identifier: BSD-3-Clause
// Visibility of a small mesh by projecting its triangles.
#pragma once

#include <vector>

#include "photometry/view.hpp"
#include "render/surface_shader.hpp"
#include "scene/scene.hpp"

namespace photonav {

/// Finds the triangle visible at every pixel centre with a depth buffer. It processes every
/// triangle of the scene in every view, so that it is faster than ray casting if there are few
/// triangles per pixel.
///
/// Works in homogeneous coordinates (Olano and Greer, "Triangle Scan Conversion using 2D
/// Homogeneous Coordinates", 1997), so that nothing is clipped: with corners p0, p1, p2 in the
/// camera frame, a ray d meets the triangle if E_i . d >= 0 for all three
///     E_i = p_j x p_k / det(p0 p1 p2),
/// and (E_0 + E_1 + E_2) . d is then the inverse depth.
class Rasterizer {
  public:
    explicit Rasterizer(const std::vector<Triangle>& triangles);

    /// Computes the visible triangle of every pixel. Thread-safe.
    /// @param visible must have the camera's size; overwritten completely
    void rasterize(const Camera& camera, const Pose& T_c_w, VisibilityImage& visible) const;

  private:
    std::size_t count_;
    /// Per triangle one corner, and the edges from it to the other two: x, y, z of each as an
    /// array over all triangles, padded to whole vectors with triangles of no area.
    std::array<std::vector<float>, 9> coordinates_;
};

}  // namespace photonav
