// SPDX-License-Identifier: BSD-3-Clause
// Values of result files.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "geometry/camera.hpp"

namespace photonav {

/// A JSON number, or null for a missing value (infinite or NaN).
nlohmann::json finiteOrNull(double value);
nlohmann::json orNull(const std::optional<double>& value);

/// Size and intrinsics [pixels].
nlohmann::json cameraJson(const Camera& camera);

}  // namespace photonav
