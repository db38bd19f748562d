// SPDX-License-Identifier: BSD-3-Clause
// Corrects the information of views of a map that was made from few noisy images.
#pragma once

#include <memory>

#include "belief/view_models.hpp"

namespace photonav {

/// The noise of the fused images remains in the map. Its gradients look like texture: a blank floor
/// would seem to determine the pose. The variance of these gradients is estimated from every new
/// image, as the part of the map's gradients that the image does not share, and their information
/// is subtracted.
class MapNoise {
  public:
    /// Adds a measurement.
    /// @param map view of the map from the image's pose, before the image is fused
    void observe(const View& map, const ImageF& image, const Camera& camera);

    /// photometricInformation() minus the information of the noise. The noise is the estimate at
    /// the time at which the model is evaluated. The model may outlive this object.
    InformationModel model(const Camera& camera, const PhotometricOptions& options) const;

    /// Estimated noise variance of a component of the image gradient, with respect to a normalised
    /// image coordinate [grey value^2].
    double variance() const { return noise_->images > 0 ? noise_->sum / noise_->images : 0.; }

  private:
    struct Noise {
        double sum = 0.;
        int images = 0;
    };
    std::shared_ptr<Noise> noise_ = std::make_shared<Noise>();
};

}  // namespace photonav
