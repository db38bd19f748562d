// SPDX-License-Identifier: BSD-3-Clause
// Models of a view for planners: information about the pose, or a penalty for flying past it.
#pragma once

#include <functional>

#include "photometry/feature_information.hpp"
#include "photometry/map_uncertainty.hpp"
#include "photometry/photometric.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// Fisher information about the pose of the camera that takes this view: camera frame, left
/// perturbation, order (rho, phi).
using InformationModel = std::function<Matrix6(const View& view)>;

/// The same by a formula of the camera pose, for sensors that need no map (and for tests).
using InformationFormula = std::function<Matrix6(const Pose& T_c_w)>;

/// The model of the paper: the sum of the photometric Jacobians over the predicted image.
InformationModel photometricModel(const Camera& camera, const PhotometricOptions& options);

/// Makes the model of a camera's views, such as photometricModel().
using MakeInformationModel =
    std::function<InformationModel(const Camera& camera, const PhotometricOptions& options)>;

/// Information of the visible corners' reprojection errors (Achtelik et al. 2014).
InformationModel featureReprojectionModel(const Camera& camera, const FeatureOptions& options);

/// Cost per metre of flying past a view, for planners whose objective is another one than the
/// uncertainty of the pose.
struct ViewPenalty {
    double base = 0.;          ///< whatever the direction of the motion
    MapCertainty reduction{};  ///< by what the motion measures of the map

    /// @param t motion of the camera by distance flown, in the axes of `reduction`: a unit vector,
    /// shorter where the camera also turns
    double along(const Eigen::Vector3d& t) const {
        return base - (1. - reduction.remainingVariance(t));
    }
};

/// Relief in the camera frame.
using PenaltyModel = std::function<ViewPenalty(const View& view)>;
using PenaltyFormula = std::function<ViewPenalty(const Pose& T_c_w)>;

/// Falls with the number of corners (Sadat et al. 2014); see featurePenalty().
PenaltyModel featureCountModel(const FeatureOptions& options);

/// The depth variance that flying past a view leaves (Forster et al. 2014); see mapCertainty().
PenaltyModel mapUncertaintyModel(const Camera& camera, const PhotometricOptions& photometric,
                                 const MapUncertaintyOptions& options);

}  // namespace photonav
