// SPDX-License-Identifier: BSD-3-Clause
#include "belief/view_models.hpp"

namespace photonav {

InformationModel photometricModel(const Camera& camera, const PhotometricOptions& options) {
    return [camera, options](const View& view) {
        return photometricInformation(view, camera, options);
    };
}

InformationModel featureReprojectionModel(const Camera& camera, const FeatureOptions& options) {
    return [camera, options](const View& view) {
        return reprojectionInformation(visibleFeatures(view, options), camera, options);
    };
}

PenaltyModel featureCountModel(const FeatureOptions& options) {
    return [options](const View& view) -> ViewPenalty {
        return {.base = featurePenalty(visibleFeatures(view, options).size(), options)};
    };
}

PenaltyModel mapUncertaintyModel(const Camera& camera, const PhotometricOptions& photometric,
                                 const MapUncertaintyOptions& options) {
    return [camera, photometric, options](const View& view) -> ViewPenalty {
        return {.base = 1., .reduction = mapCertainty(view, camera, photometric, options)};
    };
}

}  // namespace photonav
