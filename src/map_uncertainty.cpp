// SPDX-License-Identifier: BSD-3-Clause
#include "map_uncertainty.hpp"

namespace photonav {

Eigen::Matrix3d mapCertainty(const View& view, const Camera& camera,
                             const PhotometricOptions& photometric,
                             const MapUncertaintyOptions& options) {
    const double ratio = options.priorSigma * options.baseline / photometric.sigma;
    const double gain = 0.5 * ratio * ratio;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    PhotometricOptions everyPixel = photometric;
    everyPixel.stride = 1;
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            const Eigen::Vector3d j = pixelJacobian(view, camera, u, v, everyPixel).head<3>();
            sum += gain / (1. + gain * j.squaredNorm()) * j * j.transpose();
        }
    }
    return sum / (static_cast<double>(camera.width) * camera.height);
}

}  // namespace photonav
