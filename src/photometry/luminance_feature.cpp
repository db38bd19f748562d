// SPDX-License-Identifier: BSD-3-Clause
#include "photometry/luminance_feature.hpp"

#include <visp3/core/vpPixelMeterConversion.h>

namespace photonav {

void PixelDepthLuminance::buildFrom(const View& view, const Camera& camera,
                                    const PhotometricOptions& options) {
    if (nbr != camera.height || nbc != camera.width) init(camera.height, camera.width, 1.);
    cam = camera.intrinsics;
    unsigned l = 0;
    for (unsigned v = bord; v + bord < nbr; ++v) {
        for (unsigned u = bord; u + bord < nbc; ++u, ++l) {
            vpLuminance& pixel = pixInfo[l];
            vpPixelMeterConversion::convertPoint(cam, u, v, pixel.x, pixel.y);
            const Vector6 J = pixelJacobian(view, camera, u, v, options);
            // Zero for pixels that do not count; any depth will do for those.
            pixel.Z = J.isZero(0.) ? 1. : static_cast<double>(view.depth[v][u]);
            pixel.Ix = J[0] * pixel.Z;
            pixel.Iy = J[1] * pixel.Z;
            pixel.I = view.intensity[v][u];
            s[l] = pixel.I;
        }
    }
    flags[0] = true;
}

}  // namespace photonav
