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
/// s holds the grey values of all pixels but the border of one, row by row. A row of interaction()
/// is pixelJacobian(): ViSP's twist is that of the camera, ours that of the scene in the camera
/// frame, and so is the sign of the change of intensity. Pixels that do not count (see
/// photometricInformation) have a row of zeros, so a control law ignores them.
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
