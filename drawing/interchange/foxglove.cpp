// SPDX-License-Identifier: BSD-3-Clause
#include "interchange/foxglove.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <stdexcept>

#include "io/base64.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "points are stored as in memory");

constexpr const char* kFrame = "world";
constexpr std::size_t kEllipsoids = 50;
constexpr double kEllipsoidSigmas = 3.;  // of the ellipsoids' half axes, as in reports
constexpr double kLeastAxis = 1e-4;      // [m]: nothing is drawn without extent

/// The parts of an entity that are not used here, which Foxglove's definition requires.
constexpr std::array kEmptyLists{"metadata",  "arrows", "cubes", "cylinders",
                                 "triangles", "texts",  "models"};

json objectSchema(const json& properties) {
    return {{"type", "object"}, {"properties", properties}};
}
json typed(const char* type) { return {{"type", type}}; }
json bytesSchema() { return {{"type", "string"}, {"contentEncoding", "base64"}}; }

json listSchema(const json& item) { return {{"type", "array"}, {"items", item}}; }

json timeSchema() { return objectSchema({{"sec", typed("integer")}, {"nsec", typed("integer")}}); }

json vectorSchema(const char* axes) {
    json properties;
    for (const char* axis = axes; *axis != '\0'; ++axis)
        properties[std::string(1, *axis)] = typed("number");
    return objectSchema(properties);
}

json poseSchema() {
    return objectSchema({{"position", vectorSchema("xyz")}, {"orientation", vectorSchema("xyzw")}});
}

json sceneSchema() {
    const json color = vectorSchema("rgba"), point = vectorSchema("xyz");
    const json line = objectSchema({{"type", typed("integer")},
                                    {"pose", poseSchema()},
                                    {"thickness", typed("number")},
                                    {"scale_invariant", typed("boolean")},
                                    {"points", listSchema(point)},
                                    {"color", color},
                                    {"colors", listSchema(color)},
                                    {"indices", listSchema(typed("integer"))}});
    const json sphere = objectSchema({{"pose", poseSchema()}, {"size", point}, {"color", color}});
    json entity{{"timestamp", timeSchema()},
                {"frame_id", typed("string")},
                {"id", typed("string")},
                {"lifetime", timeSchema()},
                {"frame_locked", typed("boolean")},
                {"lines", listSchema(line)},
                {"spheres", listSchema(sphere)}};
    for (const char* list : kEmptyLists) entity[list] = listSchema(objectSchema(json::object()));
    const json deletion = objectSchema(
        {{"timestamp", timeSchema()}, {"type", typed("integer")}, {"id", typed("string")}});
    return objectSchema(
        {{"deletions", listSchema(deletion)}, {"entities", listSchema(objectSchema(entity))}});
}

std::map<std::string, std::string, std::less<>> makeSchemas() {
    const json stamped{{"timestamp", timeSchema()}, {"frame_id", typed("string")}};
    const auto with = [&](const json& more) {
        json properties = stamped;
        properties.update(more);
        return objectSchema(properties).dump();
    };
    const json field = objectSchema(
        {{"name", typed("string")}, {"offset", typed("integer")}, {"type", typed("integer")}});
    return {
        {"foxglove.PoseInFrame", with({{"pose", poseSchema()}})},
        {"foxglove.PointCloud", with({{"pose", poseSchema()},
                                      {"point_stride", typed("integer")},
                                      {"fields", listSchema(field)},
                                      {"data", bytesSchema()}})},
        {"foxglove.CompressedImage", with({{"data", bytesSchema()}, {"format", typed("string")}})},
        {"foxglove.SceneUpdate", sceneSchema().dump()},
        {"photonav.Belief", objectSchema({{"way_m", typed("number")},
                                          {"sigma_m", typed("number")},
                                          {"trace_m2", typed("number")}})
                                .dump()}};
}

json timeJson(double time) {
    const double seconds = std::floor(time);
    return {{"sec", static_cast<std::int64_t>(seconds)},
            {"nsec", static_cast<std::int64_t>(1e9 * (time - seconds))}};
}

json foxgloveVector(const Eigen::Vector3d& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }

json poseJson(const Pose& pose) {
    const Eigen::Quaterniond q(pose.linear());
    return {{"position", foxgloveVector(pose.translation())},
            {"orientation", {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}}}};
}

json colorJson(const Color& color, double opacity) {
    constexpr double kFull = 255.;
    return {{"r", color.red / kFull},
            {"g", color.green / kFull},
            {"b", color.blue / kFull},
            {"a", opacity}};
}

json ellipsoid(const PathPoint& point, const Color& color) {
    constexpr double kOpacity = 0.35;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(point.positionCovariance);
    Pose pose = Pose::Identity();
    pose.translation() = point.position;
    pose.linear() = axes.eigenvectors();
    if (pose.linear().determinant() < 0.) pose.linear().col(0) *= -1.;
    const Eigen::Vector3d sigma = axes.eigenvalues().cwiseMax(0.).cwiseSqrt();
    const Eigen::Vector3d size = (2. * kEllipsoidSigmas * sigma).cwiseMax(kLeastAxis);
    return {{"pose", poseJson(pose)},
            {"size", foxgloveVector(size)},
            {"color", colorJson(color, kOpacity)}};
}

}  // namespace

void GreyPoints::add(const Eigen::Vector3f& position, std::uint8_t value) {
    positions.insert(positions.end(), position.data(), position.data() + 3);
    grey.push_back(value);
}

const std::string& messageSchema(std::string_view name) {
    static const auto schemas = makeSchemas();
    const auto found = schemas.find(name);
    if (found == schemas.end()) throw std::invalid_argument("messageSchema: no such schema");
    return found->second;
}

std::string poseMessage(double time, const Pose& T_w_c) {
    return json{{"timestamp", timeJson(time)}, {"frame_id", kFrame}, {"pose", poseJson(T_w_c)}}
        .dump();
}

std::string pointCloudMessage(double time, const GreyPoints& points) {
    constexpr int kUint8 = 1, kFloat32 = 7;  // of Foxglove's NumericType
    constexpr std::size_t kPosition = 3 * sizeof(float), kStride = kPosition + 4;
    const std::size_t count = points.grey.size();
    std::string data;
    data.reserve(kStride * count);
    for (std::size_t i = 0; i < count; ++i) {
        data.append(reinterpret_cast<const char*>(&points.positions[3 * i]), kPosition);
        data.append(3, static_cast<char>(points.grey[i]));
        data.push_back('\xff');  // opaque
    }
    json fields = json::array();
    for (std::size_t i = 0; i < 3; ++i) {
        fields.push_back({{"name", std::string(1, "xyz"[i])},
                          {"offset", i * sizeof(float)},
                          {"type", kFloat32}});
    }
    constexpr std::array kColours{"red", "green", "blue", "alpha"};
    for (std::size_t i = 0; i < kColours.size(); ++i) {
        fields.push_back({{"name", kColours[i]}, {"offset", kPosition + i}, {"type", kUint8}});
    }
    return json{
        {"timestamp", timeJson(time)}, {"frame_id", kFrame}, {"pose", poseJson(Pose::Identity())},
        {"point_stride", kStride},     {"fields", fields},   {"data", base64Encode(data)}}
        .dump();
}

std::string imageMessage(double time, std::string_view bytes, const std::string& format) {
    return json{{"timestamp", timeJson(time)},
                {"frame_id", kFrame},
                {"data", base64Encode(bytes)},
                {"format", format}}
        .dump();
}

std::string pathMessage(double time, const DrawnPath& path) {
    constexpr int kLineStrip = 0;
    constexpr double kThickness = 2.;  // [pixels]
    json points = json::array(), spheres = json::array();
    const std::size_t step = 1 + path.points.size() / kEllipsoids;
    for (std::size_t i = 0; i < path.points.size(); ++i) {
        points.push_back(foxgloveVector(path.points[i].position));
        if (i % step == 0) spheres.push_back(ellipsoid(path.points[i], path.color));
    }
    const json line{{"type", kLineStrip},      {"pose", poseJson(Pose::Identity())},
                    {"thickness", kThickness}, {"scale_invariant", true},
                    {"points", points},        {"color", colorJson(path.color, 1.)},
                    {"colors", json::array()}, {"indices", json::array()}};
    json entity{
        {"timestamp", timeJson(time)}, {"frame_id", kFrame},    {"id", path.name},
        {"lifetime", timeJson(0.)},    {"frame_locked", false}, {"lines", json::array({line})},
        {"spheres", spheres}};
    for (const char* list : kEmptyLists) entity[list] = json::array();
    return json{{"deletions", json::array()}, {"entities", json::array({entity})}}.dump();
}

std::string beliefMessage(const PathPoint& point) {
    return json{{"way_m", point.distance},
                {"sigma_m", std::sqrt(std::max(0., point.positionCovariance.trace()))},
                {"trace_m2", finiteOrNull(point.trace)}}
        .dump();
}

}  // namespace photonav
