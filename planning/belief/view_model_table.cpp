// SPDX-License-Identifier: BSD-3-Clause
#include "belief/view_model_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "belief/names_of.hpp"

namespace photonav {
namespace {

struct ViewModelEntry {
    const char* name;
    ViewModel (*make)(const Camera&, const ViewModelOptions&);
};

constexpr std::array kViewModels{
    ViewModelEntry{"photometric",
                   [](const Camera& camera, const ViewModelOptions& options) -> ViewModel {
                       return options.makePhotometric(camera, options.photometric);
                   }},
    ViewModelEntry{"feature_reprojection",
                   [](const Camera& camera, const ViewModelOptions& options) -> ViewModel {
                       return featureReprojectionModel(camera, options.features);
                   }},
    ViewModelEntry{"none",
                   [](const Camera&, const ViewModelOptions&) -> ViewModel { return ViewModel(); }},
    ViewModelEntry{"feature_count",
                   [](const Camera&, const ViewModelOptions& options) -> ViewModel {
                       return featureCountModel(options.features);
                   }},
    ViewModelEntry{"map_uncertainty",
                   [](const Camera& camera, const ViewModelOptions& options) -> ViewModel {
                       return mapUncertaintyModel(camera, options.photometric, options.map);
                   }}};

}  // namespace

const std::vector<std::string>& viewModelNames() {
    static const std::vector<std::string> names = namesOf(kViewModels, &ViewModelEntry::name);
    return names;
}

ViewModel makeViewModel(const std::string& name, const Camera& camera,
                        const ViewModelOptions& options) {
    const auto* entry = std::ranges::find(kViewModels, name, &ViewModelEntry::name);
    if (entry != kViewModels.end()) return entry->make(camera, options);
    throw std::invalid_argument(fmt::format("no model of a view is named {}; the names are {}",
                                            name, fmt::join(viewModelNames(), ", ")));
}

}  // namespace photonav
