// SPDX-License-Identifier: BSD-3-Clause
// Information of views of a map that is made of few noisy images.
#pragma once

#include <memory>

#include "belief/view_models.hpp"

namespace photonav {

/// The noise of the images stays in the map, and its gradients look like texture: a blank floor
/// would seem to determine the pose. The variance of these gradients is measured with every image,
/// as the part of the map's gradients that the image does not share, and their information is
/// subtracted.
class MapNoise {
  public:
    /// An image and the view of the map from its pose, before the image is fused.
    void observe(const View& map, const ImageF& image, const Camera& camera);

    /// photometricInformation() without that of the noise as it is measured when a view is asked
    /// for. May be used as long as any of its copies is.
    InformationModel model(const Camera& camera, const PhotometricOptions& options) const;

    /// Of a component of the gradient, by unit of a normalised coordinate [grey value^2].
    double variance() const { return noise_->images > 0 ? noise_->sum / noise_->images : 0.; }

  private:
    struct Noise {
        double sum = 0.;
        int images = 0;
    };
    std::shared_ptr<Noise> noise_ = std::make_shared<Noise>();
};

}  // namespace photonav
