// SPDX-License-Identifier: BSD-3-Clause
// View models for planners: the information of a view about the pose, or a penalty of the view.
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

/// Fisher information as a formula of the camera pose, for sensors that need no map and for tests;
/// frame and order as InformationModel.
using InformationFormula = std::function<Matrix6(const Pose& T_c_w)>;

/// The model of the paper: photometricInformation(), the sum of J^T J over the predicted image
/// (eqs. (19) and (20)).
InformationModel photometricModel(const Camera& camera, const PhotometricOptions& options);

/// A function that makes the information model of a camera, such as photometricModel().
using MakeInformationModel =
    std::function<InformationModel(const Camera& camera, const PhotometricOptions& options)>;

/// Information of the visible corners' reprojection errors (Achtelik et al. 2014).
InformationModel featureReprojectionModel(const Camera& camera, const FeatureOptions& options);

/// Penalty of flying past a view. It replaces the trace in the cost, for objectives other than the
/// uncertainty of the pose.
struct ViewPenalty {
    double base = 0.;          ///< part that does not depend on the direction of the motion
    MapCertainty reduction{};  ///< how well a motion measures the map, which reduces the penalty

    /// The penalty for a direction of motion.
    /// @param t displacement of the camera divided by the distance in the metric of the flight
    ///        space, in the axes of `reduction`: a unit vector, shorter if the camera also turns
    double along(const Eigen::Vector3d& t) const {
        return base - (1. - reduction.remainingVariance(t));
    }
};

/// The penalty of a view; its `reduction` is in the camera frame.
using PenaltyModel = std::function<ViewPenalty(const View& view)>;
using PenaltyFormula = std::function<ViewPenalty(const Pose& T_c_w)>;

/// A penalty that falls with the number of visible corners (Sadat et al. 2014); see
/// featurePenalty().
PenaltyModel featureCountModel(const FeatureOptions& options);

/// The share of the map's depth variance that remains after flying past a view (Forster et al.
/// 2014); see mapCertainty().
PenaltyModel mapUncertaintyModel(const Camera& camera, const PhotometricOptions& photometric,
                                 const MapUncertaintyOptions& options);

}  // namespace photonav
