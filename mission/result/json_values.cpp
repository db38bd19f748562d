// SPDX-License-Identifier: BSD-3-Clause
#include "result/json_values.hpp"

#include <cmath>

#include "geometry/constants.hpp"

namespace photonav {
namespace {

/// Adds the places of numbers that are not finite, as JSON pointers, each with its reason.
void findNotFinite(const nlohmann::json& value, const std::string& place, nlohmann::json& found) {
    if (value.is_number_float() && !std::isfinite(value.get<double>())) {
        found[place] = std::isnan(value.get<double>()) ? "not a number" : "infinite";
    }
    if (!value.is_structured()) return;
    for (const auto& [key, part] : value.items()) findNotFinite(part, place + "/" + key, found);
}

std::string indentedText(const nlohmann::json& value) {
    return value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace

nlohmann::json finiteOrNull(double value) {
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

double nonNegative(const nlohmann::json& line, const char* key) {
    const auto value = line.at(key).get<double>();
    if (!(value >= 0. && value <= kMostOfARun)) throw std::out_of_range(key);
    return value;
}

double numberOrNone(const nlohmann::json& line, const char* key) {
    return line.at(key).is_null() ? kNone : line.at(key).get<double>();
}

nlohmann::json orNull(const std::optional<double>& value) {
    return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

std::string jsonText(const nlohmann::json& value) {
    nlohmann::json notFinite = nlohmann::json::object();
    findNotFinite(value, "", notFinite);
    if (notFinite.empty()) return indentedText(value);
    nlohmann::json whole = value;
    whole["not_finite"] = std::move(notFinite);
    return indentedText(whole);
}

std::string compactJson(const nlohmann::json& value) {
    return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

nlohmann::json cameraJson(const Camera& camera) {
    return {{"width", camera.width}, {"height", camera.height}, {"fx", camera.fx()},
            {"fy", camera.fy()},     {"cx", camera.cx()},       {"cy", camera.cy()}};
}

nlohmann::json resultJson(const std::string& command, nlohmann::json content) {
    content["schema"] = 1;
    content["command"] = command;
    content["version"] = PHOTONAV_VERSION;
    return content;
}

nlohmann::json vectorJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

nlohmann::json triangleJson(const Matrix6& matrix) {
    nlohmann::json triangle = nlohmann::json::array();
    for (int i = 0; i < 6; ++i) {
        for (int j = i; j < 6; ++j) triangle.push_back(matrix(i, j));
    }
    return triangle;
}

}  // namespace photonav
