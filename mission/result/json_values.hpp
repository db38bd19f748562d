// SPDX-License-Identifier: BSD-3-Clause
// JSON values of result files.
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
/// A JSON number, or null for no value.
nlohmann::json orNull(const std::optional<double>& value);

/// The content of a result.json: an object, to which schema, command and version are added.
nlohmann::json resultJson(const std::string& command, nlohmann::json content);

/// [x, y, z].
nlohmann::json vectorJson(const Eigen::Vector3d& v);

/// The coefficients of a matrix, row by row.
template <typename Derived>
nlohmann::json matrixJson(const Eigen::MatrixBase<Derived>& matrix) {
    nlohmann::json values = nlohmann::json::array();
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
        for (Eigen::Index j = 0; j < matrix.cols(); ++j) values.push_back(matrix(i, j));
    }
    return values;
}

/// The inverse of matrixJson(). @throws std::exception for another number of values
template <int rows, int columns>
Eigen::Matrix<double, rows, columns> matrixFrom(const nlohmann::json& values) {
    if (values.size() != std::size_t{rows * columns}) throw std::out_of_range("size");
    Eigen::Matrix<double, rows, columns> matrix;
    for (int i = 0; i < rows * columns; ++i) matrix(i / columns, i % columns) = values.at(i);
    return matrix;
}

/// The upper triangle of a symmetric matrix, row by row (21 numbers).
nlohmann::json triangleJson(const Matrix6& matrix);

/// The convention of pose covariances in result files, as text.
inline constexpr const char* kCovarianceFrame =
    "camera, left perturbation T_c_w = exp(xi) mean, order (rho, phi), upper triangle by rows";

/// More than any cost, length, trace or time of a run.
inline constexpr double kMostOfARun = 1e12;

/// The value of a key, a number in [0, kMostOfARun].
/// @throws std::exception for other values
double nonNegative(const nlohmann::json& line, const char* key);

/// The value of a key, a number; NaN for null. @throws std::exception for other values
double numberOrNone(const nlohmann::json& line, const char* key);

/// A non-negative integer of type Number. @throws std::exception for a value that is none or is too
/// large for the type
template <typename Number>
Number wholeNumber(const nlohmann::json& value) {
    if (!value.is_number_unsigned()) throw std::invalid_argument("not a whole number");
    const auto number = value.get<std::uint64_t>();
    if (number > static_cast<std::uint64_t>(std::numeric_limits<Number>::max())) {
        throw std::out_of_range("too large");
    }
    return static_cast<Number>(number);
}

/// The text of a result file, one value per line. Bytes that are not UTF-8 (in a file name, for
/// example) are replaced: they cause no error. Numbers that are not finite become null; the member
/// `not_finite` gives the place and the reason of each.
std::string jsonText(const nlohmann::json& value);

/// The text of a value without line breaks. Bytes that are not UTF-8 are replaced; numbers that are
/// not finite become null.
std::string compactJson(const nlohmann::json& value);

/// Image size and intrinsics [pixels].
nlohmann::json cameraJson(const Camera& camera);

}  // namespace photonav
