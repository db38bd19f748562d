// SPDX-License-Identifier: BSD-3-Clause
// Values of result files.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "geometry/camera.hpp"

namespace photonav {

/// A JSON number, or null for a missing value (infinite or NaN).
nlohmann::json finiteOrNull(double value);
nlohmann::json orNull(const std::optional<double>& value);

/// A result file's text, one value per line. Bytes that are not UTF-8 (of a file name, say) are
/// replaced: nothing that was computed is lost for them.
std::string jsonText(const nlohmann::json& value);

/// The same on one line.
std::string jsonLine(const nlohmann::json& value);

/// Size and intrinsics [pixels].
nlohmann::json cameraJson(const Camera& camera);

}  // namespace photonav
