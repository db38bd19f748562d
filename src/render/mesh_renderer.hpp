// SPDX-License-Identifier: BSD-3-Clause
// Views of a textured triangle scene by ray casting (the only includer of Embree is its .cpp).
#pragma once

#include <memory>

#include "photometry/view.hpp"
#include "scene/scene.hpp"

namespace photonav {

/// Renders views of a scene. Visibility at pixel centres is exact: by a depth buffer if there are
/// few triangles per pixel, else by Embree's ray packets; both find the same triangles. Depth and
/// grey value follow from the plane of the visible triangle (surface_shader.hpp). A pixel that the
/// border of two surfaces crosses shows both, by their shares of its area (border_finder.hpp). Both
/// sides of a triangle are visible.
class MeshRenderer : public ViewSource {
  public:
    explicit MeshRenderer(Scene scene);
    ~MeshRenderer() override;
    MeshRenderer(MeshRenderer&&) noexcept;
    MeshRenderer& operator=(MeshRenderer&&) noexcept;

    void render(const Camera& camera, const Pose& T_c_w, View& view) const override;

    const Scene& scene() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace photonav
