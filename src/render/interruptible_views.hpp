// SPDX-License-Identifier: BSD-3-Clause
// Large views in bands of rows, between which rendering can be stopped.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <stdexcept>

#include "photometry/view.hpp"

namespace photonav {

/// Thrown out of a view that was to be stopped.
struct RenderingStopped : std::runtime_error {
    RenderingStopped() : std::runtime_error("interrupted while rendering a view") {}
};

/// Larger views than this are rendered in bands [pixels].
inline constexpr std::size_t kBandPixels = std::size_t{1} << 21U;

inline std::size_t pixelsOf(const Camera& camera) {
    return std::size_t{camera.width} * camera.height;
}

/// Renders a view in bands of whole rows with at most `pixels` pixels each, or at once where it has
/// no more. A band has one row more on either side for the point spread, which is left out.
/// @param render fills a view of the camera it is given
void renderInBands(const Camera& camera, std::size_t pixels,
                   const std::function<void(const Camera& band, View& view)>& render, View& view);

/// The views of another source. Large ones end with RenderingStopped within a band; small ones,
/// which take milliseconds, are never stopped and cost nothing more.
class InterruptibleViews : public ViewSource {
  public:
    InterruptibleViews(std::shared_ptr<const ViewSource> views, std::function<bool()> isStopped)
        : views_(std::move(views)), isStopped_(std::move(isStopped)) {}

    void render(const Camera& camera, const Pose& T_c_w, View& view) const override;

  private:
    std::shared_ptr<const ViewSource> views_;
    std::function<bool()> isStopped_;
};

}  // namespace photonav
