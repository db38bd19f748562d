// SPDX-License-Identifier: BSD-3-Clause
// Renders large views in bands of rows; rendering can be stopped between two bands.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "io/interrupted.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// Size above which views are rendered in bands [pixels].
inline constexpr std::size_t kBandPixels = std::size_t{1} << 21U;

/// Number of pixels of a camera's images.
inline std::size_t pixelsOf(const Camera& camera) {
    return std::size_t{camera.width} * camera.height;
}

/// Renders a view in bands of whole rows with at most `pixels` pixels each (but at least one row),
/// or at once if it has no more pixels. Each band is rendered with two more rows on either side, on
/// which its own depend.
/// @param render renders a view for the camera of a band
void renderInBands(const Camera& camera, std::size_t pixels,
                   const std::function<void(const Camera& band, View& view)>& render, View& view);

/// The views of another source, which can be stopped. A large view throws Interrupted before
/// its next band when `isStopped` returns true. Views of at most kBandPixels, which take
/// milliseconds, are never stopped.
class InterruptibleViews : public ViewSource {
  public:
    InterruptibleViews(std::shared_ptr<const ViewSource> views, IsStopped isStopped)
        : views_(std::move(views)), isStopped_(std::move(isStopped)) {}

    void render(const Camera& camera, const Pose& T_c_w, View& view) const override;

  private:
    std::shared_ptr<const ViewSource> views_;
    IsStopped isStopped_;
};

}  // namespace photonav
