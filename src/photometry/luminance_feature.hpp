// SPDX-License-Identifier: BSD-3-Clause
// The photometric feature of ViSP with the depth of every pixel instead of one for the image.
#pragma once

#include <visp3/visual_features/vpFeatureLuminance.h>

#include "photometry/photometric.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// The reference formulation of the photometric Jacobian, and a feature for visual servoing: usable
/// wherever vpFeatureLuminance is (vpServo::addFeature, interaction(), error()).
///
/// s holds the grey values row by row, without a border of one pixel. A row of interaction() equals
/// pixelJacobian(). Two signs cancel: ViSP's twist moves the camera, ours moves the scene in the
/// camera frame, and the change of intensity has the opposite sign as well. Pixels that
/// photometricInformation() leaves out have a row of zeros, so a control law ignores them.
class PixelDepthLuminance : public vpFeatureLuminance {
  public:
    PixelDepthLuminance() { bord = 1; }
    PixelDepthLuminance(const PixelDepthLuminance&) = default;
    PixelDepthLuminance& operator=(const PixelDepthLuminance&) = delete;  // ViSP's forgets s
    ~PixelDepthLuminance() override = default;

    /// Sets grey values, gradients and depths. The view must be camera.height x camera.width, at
    /// least 3 x 3.
    void buildFrom(const View& view, const Camera& camera, const PhotometricOptions& options = {});

    PixelDepthLuminance* duplicate() const override { return new PixelDepthLuminance(*this); }
};

}  // namespace photonav
