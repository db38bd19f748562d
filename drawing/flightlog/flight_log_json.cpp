// SPDX-License-Identifier: BSD-3-Clause
// FlightLog to JSON and back.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "flightlog/flight_log.hpp"
#include "io/base64.hpp"
#include "io/image_bytes.hpp"
#include "io/json_nesting.hpp"
#include "io/reading.hpp"
#include "replanning/plan_update_json.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little,
              "arrays are stored as they lie in memory");

template <typename T>
json arrayText(const std::vector<T>& values) {
    return base64Encode({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

/// @param group the array holds a multiple of as many values
template <typename T>
std::vector<T> arrayFrom(const json& text, std::size_t group) {
    const std::string bytes = base64Decode(text.get_ref<const std::string&>());
    if (bytes.size() % (group * sizeof(T)) != 0) throw std::invalid_argument("size of an array");
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

// A point of the way: time, way, believed and true place, trace, heading.
constexpr std::size_t kFlownValues = 10;

json flownJson(const std::vector<FlownPoint>& flown) {
    std::vector<float> values;
    for (const FlownPoint& point : flown) {
        values.insert(values.end(), {point.time, point.length});
        values.insert(values.end(), point.believed.data(), point.believed.data() + 3);
        values.insert(values.end(), point.truth.data(), point.truth.data() + 3);
        values.insert(values.end(), {point.trace, point.yaw});
    }
    return arrayText(values);
}

std::vector<FlownPoint> flownFrom(const json& text) {
    const std::vector<float> v = arrayFrom<float>(text, kFlownValues);
    std::vector<FlownPoint> flown;
    for (std::size_t i = 0; i < v.size(); i += kFlownValues) {
        flown.push_back({v[i], v[i + 1], Eigen::Vector3f(v.data() + i + 2),
                         Eigen::Vector3f(v.data() + i + 5), v[i + 8], v[i + 9]});
    }
    return flown;
}

// A point of the plan: place, upper triangle of its covariance, trace, distance.
constexpr std::size_t kPlanValues = 11;

json planJson(const std::vector<PathPoint>& plan) {
    std::vector<float> values;
    const auto add = [&](double value) { values.push_back(static_cast<float>(value)); };
    for (const PathPoint& point : plan) {
        for (int i = 0; i < 3; ++i) add(point.position[i]);
        for (int i = 0; i < 3; ++i)
            for (int j = i; j < 3; ++j) add(point.positionCovariance(i, j));
        add(point.trace);
        add(point.distance);
    }
    return arrayText(values);
}

std::vector<PathPoint> planFrom(const json& text) {
    const std::vector<float> values = arrayFrom<float>(text, kPlanValues);
    std::vector<PathPoint> plan;
    for (auto v = values.begin(); v != values.end();) {
        PathPoint& point = plan.emplace_back();
        for (int i = 0; i < 3; ++i) point.position[i] = *v++;
        for (int i = 0; i < 3; ++i)
            for (int j = i; j < 3; ++j)
                point.positionCovariance(i, j) = point.positionCovariance(j, i) = *v++;
        point.trace = *v++;
        point.distance = *v++;
    }
    return plan;
}

// Ends of the edges in 65535ths of the box, which all lie in.
constexpr double kFullScale = 65535.;

json treeJson(const std::vector<Edge>& tree, const Eigen::AlignedBox3d& box) {
    std::vector<std::uint16_t> values;
    for (const Edge& edge : tree) {
        for (const Eigen::Vector3f& end : edge) {
            const Eigen::Array3d share =
                (end.cast<double>() - box.min()).array() / box.sizes().array().max(1e-9);
            for (int i = 0; i < 3; ++i)
                values.push_back(static_cast<std::uint16_t>(
                    std::lround(kFullScale * std::clamp(share[i], 0., 1.))));
        }
    }
    return arrayText(values);
}

std::vector<Edge> treeFrom(const json& text, const Eigen::AlignedBox3d& box) {
    const auto values = arrayFrom<std::uint16_t>(text, 6);
    std::vector<Edge> tree(values.size() / 6);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto axis = static_cast<Eigen::Index>(i % 3);
        tree[i / 6][i / 3 % 2][axis] =
            static_cast<float>(box.min()[axis] + values[i] / kFullScale * box.sizes()[axis]);
    }
    return tree;
}

LoggedMoment momentFrom(const json& content, const Eigen::AlignedBox3d& box) {
    LoggedMoment moment;
    moment.update = planUpdateFrom(content.at("update"));
    moment.length = content.at("way");
    const json& robot = content.at("robot");
    moment.robot.T_w_c.matrix().topRows<3>() = matrixFrom<3, 4>(robot.at("T_w_c_rows"));
    moment.robot.position = moment.robot.T_w_c.translation();
    moment.robot.positionCovariance = matrixFrom<3, 3>(robot.at("position_covariance"));
    moment.robot.trace = moment.update.trace;
    moment.robot.distance = moment.length;
    moment.flown = flownFrom(content.at("flown"));
    moment.plan = planFrom(content.at("plan"));
    moment.cells.indices = arrayFrom<std::int16_t>(content.at("cells"), 3);
    moment.cells.greys = arrayFrom<std::uint8_t>(content.at("greys"), 1);
    if (moment.cells.indices.size() != 3 * moment.cells.greys.size())
        throw std::invalid_argument("cells and greys differ in number");
    const auto file = [&](const char* key) {
        return content.contains(key) ? base64Decode(content[key].get<std::string>()) : "";
    };
    if (content.contains("tree")) moment.pictures.tree = treeFrom(content["tree"], box);
    moment.pictures.observed = file("observed");
    moment.pictures.predicted = file("predicted");
    moment.pictures.obstacles = file("obstacles");
    moment.pictures.information = file("information");
    return moment;
}

template <typename Box>
Box boxFrom(const json& corners) {
    constexpr int dimensions = Box::AmbientDimAtCompileTime;
    const Box box(matrixFrom<dimensions, 1>(corners.at(0)),
                  matrixFrom<dimensions, 1>(corners.at(1)));
    if (box.isEmpty()) throw std::invalid_argument("empty box");
    return box;
}

}  // namespace

std::uint8_t informationLevel(double trace) {
    if (!(trace >= 1.)) return 0;
    const double level = kLevelsPerDecade * std::log10(trace);
    return static_cast<std::uint8_t>(std::lround(std::min(level, kNoInformation - 1.)));
}

json headerJson(const FlightLog& log) {
    return {{"planner", log.planner},
            {"color", hexColor(plannerColor(log.planner))},
            {"seed", log.seed},
            {"box", {matrixJson(log.box.min()), matrixJson(log.box.max())}},
            {"scene", {matrixJson(log.scene.min()), matrixJson(log.scene.max())}},
            {"area", {matrixJson(log.area.min()), matrixJson(log.area.max())}},
            {"cell", log.cell}};
}

json momentJson(const FlightLog& log, const LoggedMoment& moment) {
    json content{{"update", lineOf(moment.update)},
                 {"way", moment.length},
                 {"robot",
                  {{"T_w_c_rows", matrixJson(moment.robot.T_w_c.matrix().topRows<3>())},
                   {"position_covariance", matrixJson(moment.robot.positionCovariance)}}},
                 {"flown", flownJson(moment.flown)},
                 {"plan", planJson(moment.plan)},
                 {"cells", arrayText(moment.cells.indices)},
                 {"greys", arrayText(moment.cells.greys)}};
    const MomentPictures& pictures = moment.pictures;
    if (pictures.empty()) return content;
    content["tree"] = treeJson(pictures.tree, log.box);
    const auto addFile = [&](const char* key, const std::string& bytes) {
        if (!bytes.empty()) content[key] = base64Encode(bytes);
    };
    addFile("observed", pictures.observed);
    addFile("predicted", pictures.predicted);
    addFile("obstacles", pictures.obstacles);
    addFile("information", pictures.information);
    return content;
}

json endJson(const FlightLog& log) {
    return {{"end", log.end}, {"reason", log.reason}, {"flown", flownJson(log.rest)}};
}

json flightLogJson(const FlightLog& log) {
    json moments = json::array();
    for (const LoggedMoment& moment : log.moments) moments.push_back(momentJson(log, moment));
    return {{"header", headerJson(log)}, {"moments", std::move(moments)}, {"end", endJson(log)}};
}

FlightLog flightLogFrom(const json& content) {
    FlightLog log;
    const json& header = content.at("header");
    log.planner = header.at("planner");
    log.seed = wholeNumber<std::uint32_t>(header.at("seed"));
    log.box = boxFrom<Eigen::AlignedBox3d>(header.at("box"));
    log.scene = boxFrom<Eigen::AlignedBox3d>(header.at("scene"));
    log.area = boxFrom<Eigen::AlignedBox2d>(header.at("area"));
    log.cell = header.at("cell");
    if (!(log.cell > 0.)) throw std::invalid_argument("size of cells");
    for (const json& moment : content.at("moments"))
        log.moments.push_back(momentFrom(moment, log.box));
    const json& end = content.at("end");
    log.end = end.at("end");
    log.reason = end.at("reason");
    log.rest = flownFrom(end.at("flown"));
    return log;
}

FlightLog readFlightLog(const std::filesystem::path& file) {
    return reading(file.string(), [&] {
        const auto bytes = readBytes(file.string());
        const std::string text(bytes.begin(), bytes.end());
        if (nestingDepth(text) > kMostJsonDepth) {
            throw InputError(file.string(), "", "nested too deep");
        }
        return flightLogFrom(json::parse(text));
    });
}

}  // namespace photonav
