// SPDX-License-Identifier: BSD-3-Clause
// All models of a view by name.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "belief/view_models.hpp"

namespace photonav {

/// Information about the pose, a penalty in its place, or none (std::monostate).
using ViewModel = std::variant<std::monostate, InformationModel, PenaltyModel>;

/// What the models are made of.
struct ViewModelOptions {
    PhotometricOptions photometric;
    FeatureOptions features;
    MapUncertaintyOptions map;
    MakeInformationModel makePhotometric = photometricModel;
};

/// Names that makeViewModel() accepts.
const std::vector<std::string>& viewModelNames();

/// A model of the views of a camera.
/// @throws std::invalid_argument for an unknown name
ViewModel makeViewModel(const std::string& name, const Camera& camera,
                        const ViewModelOptions& options);

}  // namespace photonav
