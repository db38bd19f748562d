// SPDX-License-Identifier: BSD-3-Clause
#include "check/predicted_image.hpp"

#include <utility>

#include "alignment/conclusion.hpp"

namespace photonav {

ImagePredictor::ImagePredictor(const ViewSource& map, const Camera& camera,
                               const PhotometricOptions& photometric,
                               const AlignmentOptions& alignment, IsStopped isStopped)
    : map_(map),
      camera_(camera),
      photometric_(photometric),
      alignment_(alignment),
      comparison_(camera, alignment.photometric, std::move(isStopped)) {}

PredictedImage ImagePredictor::at(const Pose& T_c_w) {
    map_.render(camera_, T_c_w, view_);
    PredictedImage image{photometricInformation(view_, camera_, photometric_), {}};
    const NormalEquations equations = comparison_(view_, view_.intensity, Exposure{}, Loss{});
    image.alignment.T_c_w = T_c_w;
    image.alignment.verdict = Verdict::converged;
    conclude(image.alignment,
             {.equations = equations,
              .pixels = view_.intensity.getSize(),
              .image = {poseEquations(equations, alignment_.photometric, alignment_.exposure)}},
             alignment_);
    return image;
}

}  // namespace photonav
