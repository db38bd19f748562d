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

/// A result.json: an object, with schema, command and version added.
nlohmann::json resultJson(const std::string& command, nlohmann::json content);

nlohmann::json vectorJson(const Eigen::Vector3d& v);

/// The upper triangle of a symmetric matrix, by rows.
nlohmann::json triangleJson(const Matrix6& matrix);

/// What covariances of poses in result files are.
inline constexpr const char* kCovarianceFrame =
    "camera, left perturbation T_c_w = exp(xi) mean, order (rho, phi), upper triangle by rows";

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
