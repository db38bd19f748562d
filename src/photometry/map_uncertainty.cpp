// SPDX-License-Identifier: BSD-3-Clause
#include "photometry/map_uncertainty.hpp"

namespace photonav {

MapCertainty mapCertainty(const View& view, const Camera& camera,
                          const PhotometricOptions& photometric,
                          const MapUncertaintyOptions& options) {
    const double ratio = options.priorSigma * options.baseline / photometric.sigma;
    const double unit = 0.5 * ratio * ratio;
    PhotometricOptions everyPixel = photometric;
    everyPixel.stride = 1;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    unsigned pixels = 0;
    unsigned counted = 0;
    for (unsigned v = 0; v < camera.height; v += options.stride) {
        for (unsigned u = 0; u < camera.width; u += options.stride) {
            ++pixels;
            const Eigen::Vector3d j = pixelJacobian(view, camera, u, v, everyPixel).head<3>();
            if (unit * j.squaredNorm() < 1.) continue;
            sum += unit * j * j.transpose();
            ++counted;
        }
    }
    if (counted == 0) return {};
    return {.share = static_cast<double>(counted) / pixels, .gain = sum / counted};
}

}  // namespace photonav
