// SPDX-License-Identifier: BSD-3-Clause
// Values of result files.
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "geometry/camera.hpp"

namespace photonav {

/// A JSON number, or null for a missing value (infinite or NaN).
nlohmann::json finiteOrNull(double value);
nlohmann::json orNull(const std::optional<double>& value);

/// A whole number that the type can hold. @throws std::exception for other values
template <typename Number>
Number wholeNumber(const nlohmann::json& value) {
    if (!value.is_number_unsigned()) throw std::invalid_argument("not a whole number");
    const auto number = value.get<std::uint64_t>();
    if (number > static_cast<std::uint64_t>(std::numeric_limits<Number>::max())) {
        throw std::out_of_range("too large");
    }
    return static_cast<Number>(number);
}

/// A result file's text, one value per line. Bytes that are not UTF-8 (of a file name, say) are
/// replaced: nothing that was computed is lost for them.
std::string jsonText(const nlohmann::json& value);

/// The same on one line.
std::string jsonLine(const nlohmann::json& value);

/// Size and intrinsics [pixels].
nlohmann::json cameraJson(const Camera& camera);

}  // namespace photonav
