// SPDX-License-Identifier: BSD-3-Clause
// ReportData to JSON.
#include <bit>

#include "io/base64.hpp"
#include "io/error.hpp"
#include "io/image_bytes.hpp"
#include "io/json_nesting.hpp"
#include "io/reading.hpp"
#include "report/report.hpp"

namespace photonav {
namespace {

using nlohmann::json;

constexpr int kSchema = 1;
constexpr std::string_view kPngPrefix = "data:image/png;base64,";
static_assert(std::endian::native == std::endian::little,
              "arrays are stored as they lie in memory");

template <typename T>
std::string packed(const std::vector<T>& values) {
    return base64Encode({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

std::string dataUri(const Png& image) {
    return image.empty() ? "" : std::string(kPngPrefix) + base64Encode(image);
}

template <typename Derived>
json numbers(const Eigen::MatrixBase<Derived>& matrix) {
    json list = json::array();
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
        for (Eigen::Index j = 0; j < matrix.cols(); ++j) list.push_back(matrix(i, j));
    return list;
}

json pointToJson(const PathPoint& point) {
    json content{{"position", numbers(point.position)},
                 {"T_w_c_rows", numbers(point.T_w_c.matrix().topRows<3>())},
                 {"trace", point.trace},
                 {"position_covariance", numbers(point.positionCovariance)},
                 {"distance", point.distance},
                 {"cost", point.cost}};
    if (point.traceBefore) content["trace_before"] = *point.traceBefore;
    return content;
}

json pathToJson(const DrawnPath& path) {
    json points = json::array();
    for (const PathPoint& point : path.points) points.push_back(pointToJson(point));
    json content{{"name", path.name}, {"color", hexColor(path.color)}, {"points", points}};
    if (path.meanTrace) content["mean_trace"] = *path.meanTrace;
    return content;
}

json treeToJson(const DrawnTree& tree) {
    static_assert(sizeof(Edge) == 6 * sizeof(float));
    return {{"name", tree.name}, {"color", hexColor(tree.color)}, {"edges", packed(tree.edges)}};
}

json frameToJson(const ReportFrame& frame) {
    json content{{"caption", frame.caption},
                 {"image", dataUri(frame.image)},
                 {"series", frame.series},
                 {"color", hexColor(frame.color)}};
    if (frame.believed) content["believed"] = pointToJson(*frame.believed);
    if (frame.truth) content["truth"] = numbers(*frame.truth);
    return content;
}

void checkReport(const std::string& file, const std::string& text) {
    if (nestingDepth(text) > kMostJsonDepth) throw InputError(file, "", "nested too deep");
    const json content = json::parse(text, nullptr, false);
    if (content.is_discarded()) throw InputError(file, "", "not JSON, or only a part of it");
    if (!content.is_object() || !content.contains("schema"))
        throw InputError(file, "schema", "missing; is this a report of photonav?");
    if (content["schema"] != kSchema)
        throw InputError(file, "schema", "written by another version of photonav");
}

}  // namespace

std::string reportJson(const ReportData& data) {
    json root{{"schema", kSchema},          {"title", data.title},
              {"subtitle", data.subtitle},  {"command_line", data.commandLine},
              {"version", data.version},    {"result", data.result},
              {"config", data.config},      {"start", numbers(data.start)},
              {"goal", numbers(data.goal)}, {"field_of_view", numbers(data.fieldOfView)}};
    root["mesh"] = {{"positions", packed(data.mesh.positions)},
                    {"uv", packed(data.mesh.uv)},
                    {"textures", packed(data.mesh.textures)},
                    {"images", json::array()}};
    for (const Png& image : data.mesh.images) root["mesh"]["images"].push_back(dataUri(image));
    root["voxels"] = {{"centers", packed(data.voxels.centers)},
                      {"grey", packed(data.voxels.grey)},
                      {"size", data.voxels.size}};
    for (const char* list :
         {"trees", "paths", "views", "progress", "figures", "frames", "tables", "text_tables"})
        root[list] = json::array();
    for (const DrawnTree& tree : data.trees) root["trees"].push_back(treeToJson(tree));
    for (const DrawnPath& path : data.paths) root["paths"].push_back(pathToJson(path));
    for (const ReportView& view : data.views)
        root["views"].push_back({{"point", view.point},
                                 {"image", dataUri(view.image)},
                                 {"contribution", dataUri(view.contribution)}});
    for (const PlanProgress& step : data.progress)
        root["progress"].push_back({{"vertices", step.vertices},
                                    {"seconds", step.seconds},
                                    {"cost", step.cost},
                                    {"views", step.views}});
    for (const ReportFigure& figure : data.figures)
        root["figures"].push_back({{"caption", figure.caption}, {"image", dataUri(figure.image)}});
    for (const ReportFrame& frame : data.frames) root["frames"].push_back(frameToJson(frame));
    for (const ReportTable& table : data.tables)
        root["tables"].push_back({{"title", table.title}, {"rows", table.rows}});
    for (const auto& [title, table, note] : data.textTables)
        root["text_tables"].push_back(
            {{"title", title}, {"head", table.head}, {"rows", table.rows}, {"note", note}});
    if (!data.flight.is_null()) root["flight"] = data.flight;
    root["planner_colors"] = json::object();
    for (const json& planner : data.result.value("planners", json::array()))
        if (planner.is_string()) {
            const auto name = planner.get<std::string>();
            root["planner_colors"][name] = hexColor(plannerColor(name));
        }
    return root.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string readReportJson(const std::filesystem::path& file) {
    return reading(file.string(), [&] {
        const auto bytes = readBytes(file.string());
        const std::string text(bytes.begin(), bytes.end());
        checkReport(file.string(), text);
        return text;
    });
}

std::string readReportOf(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "report.json";
    if (std::filesystem::exists(file)) return readReportJson(file);
    throw InputError(folder.string(), "", "not a result folder of photonav: no report.json");
}

}  // namespace photonav
