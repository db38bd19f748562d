// SPDX-License-Identifier: BSD-3-Clause
#include "render/interruptible_views.hpp"

#include <algorithm>

namespace photonav {
namespace {

/// Rows beyond a band on which its own depend: the point spread needs one, and this one depends on
/// the surfaces seen from the next one.
constexpr unsigned kMargin = 2;

/// The rows from `first` up to, not including, `end` of a camera's image.
Camera rowsOf(const Camera& camera, unsigned first, unsigned end) {
    return {camera.width, end - first,
            vpCameraParameters(camera.fx(), camera.fy(), camera.cx(), camera.cy() - first),
            camera.hasPointSpread};
}

/// Copies whole rows.
void copyImageRows(const ImageF& from, unsigned first, unsigned count, ImageF& to, unsigned at) {
    std::copy_n(from[first], std::size_t{count} * from.getWidth(), to[at]);
}

}  // namespace

void renderInBands(const Camera& camera, std::size_t pixels,
                   const std::function<void(const Camera& band, View& view)>& render, View& view) {
    if (pixelsOf(camera) <= pixels) return render(camera, view);
    const auto rows = static_cast<unsigned>(std::max<std::size_t>(1, pixels / camera.width));
    view.intensity.resize(camera.height, camera.width);
    view.depth.resize(camera.height, camera.width);
    View band;
    for (unsigned v = 0; v < camera.height; v += rows) {
        const unsigned count = std::min(rows, camera.height - v);
        const unsigned above = std::min(v, kMargin);
        render(rowsOf(camera, v - above, std::min(v + count + kMargin, camera.height)), band);
        copyImageRows(band.intensity, above, count, view.intensity, v);
        copyImageRows(band.depth, above, count, view.depth, v);
    }
}

void InterruptibleViews::render(const Camera& camera, const Pose& T_c_w, View& view) const {
    if (pixelsOf(camera) <= kBandPixels) return views_->render(camera, T_c_w, view);
    const auto renderBand = [&](const Camera& band, View& part) {
        throwIfStopped(isStopped_);
        views_->render(band, T_c_w, part);
    };
    renderInBands(camera, kBandPixels, renderBand, view);
}

}  // namespace photonav
