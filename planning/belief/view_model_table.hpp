// SPDX-License-Identifier: BSD-3-Clause
// Makes view models by name.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "belief/view_models.hpp"

namespace photonav {

/// A model of a view: its information about the pose, a penalty instead, or neither
/// (std::monostate).
using ViewModel = std::variant<std::monostate, InformationModel, PenaltyModel>;

/// Options of all view models.
struct ViewModelOptions {
    PhotometricOptions photometric;
    FeatureOptions features;
    MapUncertaintyOptions map;
    MakeInformationModel makePhotometric = photometricModel;
};

/// Names that makeViewModel() accepts.
const std::vector<std::string>& viewModelNames();

/// Makes the view model of this name for the views of a camera.
/// @throws std::invalid_argument for an unknown name
ViewModel makeViewModel(const std::string& name, const Camera& camera,
                        const ViewModelOptions& options);

}  // namespace photonav
