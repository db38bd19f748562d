// SPDX-License-Identifier: BSD-3-Clause
#include "render/area_sensor.hpp"

#include <stdexcept>

#include "render/interruptible_views.hpp"

namespace photonav {

AreaSensor::AreaSensor(const ViewSource& world, unsigned samples)
    : world_(world), samples_(samples) {
    if (samples == 0) throw std::invalid_argument("area sensor: no samples");
}

void AreaSensor::render(const Camera& camera, const Pose& T_c_w, View& view) const {
    // In bands, or the rays of a large image would take several gigabytes.
    const std::size_t pixels = 2 * kBandPixels / (std::size_t{samples_} * samples_);
    const auto average = [&](const Camera& band, View& part) { renderAtOnce(band, T_c_w, part); };
    renderInBands(camera, pixels, average, view);
}

void AreaSensor::renderAtOnce(const Camera& camera, const Pose& T_c_w, View& view) const {
    const unsigned n = samples_;
    const auto centre = [n](double c) { return n * (c + 0.5) - 0.5; };
    const Camera fine{n * camera.width, n * camera.height,
                      vpCameraParameters(n * camera.fx(), n * camera.fy(), centre(camera.cx()),
                                         centre(camera.cy())),
                      camera.hasPointSpread};
    View rays;
    world_.render(fine, T_c_w, rays);
    view.intensity.resize(camera.height, camera.width);
    view.depth.resize(camera.height, camera.width);
    const float share = 1.F / static_cast<float>(n * n);
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            float sum = 0.F;
            for (unsigned j = 0; j < n; ++j) {
                const float* row = rays.intensity[n * v + j] + std::size_t(n) * u;
                for (unsigned i = 0; i < n; ++i) sum += row[i];
            }
            view.intensity[v][u] = share * sum;
            view.depth[v][u] = rays.depth[n * v + n / 2][n * u + n / 2];
        }
    }
}

}  // namespace photonav
