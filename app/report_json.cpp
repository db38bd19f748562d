// SPDX-License-Identifier: BSD-3-Clause
// ReportData to JSON and back.
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>

#include "base64.hpp"
#include "error.hpp"
#include "report.hpp"

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

std::string hexColor(const Color& color) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text = "#";
    for (const std::uint8_t channel : {color.red, color.green, color.blue}) {
        text += digits[channel >> 4];
        text += digits[channel & 15];
    }
    return text;
}

template <typename Derived>
json numbers(const Eigen::MatrixBase<Derived>& matrix) {
    json list = json::array();
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
        for (Eigen::Index j = 0; j < matrix.cols(); ++j) list.push_back(matrix(i, j));
    return list;
}

json pointToJson(const PathPoint& point) {
    return {{"position", numbers(point.position)},
            {"T_w_c_rows", numbers(point.T_w_c.matrix().topRows<3>())},
            {"trace", point.trace},
            {"position_covariance", numbers(point.positionCovariance)},
            {"distance", point.distance},
            {"cost", point.cost}};
}

json pathToJson(const DrawnPath& path) {
    json points = json::array();
    for (const PathPoint& point : path.points) points.push_back(pointToJson(point));
    return {{"name", path.name}, {"color", hexColor(path.color)}, {"points", points}};
}

json treeToJson(const DrawnTree& tree) {
    static_assert(sizeof(Edge) == 6 * sizeof(float));
    return {{"name", tree.name}, {"color", hexColor(tree.color)}, {"edges", packed(tree.edges)}};
}

/// One value of the JSON tree and where it stands, for messages.
class Node {
  public:
    Node(const json& value, std::string file, std::string key)
        : value_(value), file_(std::move(file)), key_(std::move(key)) {}

    Node operator[](const char* name) const {
        const std::string key = key_.empty() ? name : key_ + "." + name;
        if (!value_.is_object() || !value_.contains(name))
            throw InputError(file_, key, "missing; is this a report of photonav?");
        return {value_.at(name), file_, key};
    }

    template <typename T>
    T as() const {
        try {
            return value_.get<T>();
        } catch (const json::exception&) {
            fail(std::string("unexpected ") + value_.type_name());
        }
    }

    const json& raw() const { return value_; }

    /// JSON has no NaN or infinity: they were written as null.
    double number() const {
        return value_.is_null() ? std::numeric_limits<double>::quiet_NaN() : as<double>();
    }

    template <typename Visitor>
    void forEach(const Visitor& visit) const {
        if (!value_.is_array()) fail("a list is expected");
        for (std::size_t i = 0; i < value_.size(); ++i)
            visit(Node(value_[i], file_, key_ + "[" + std::to_string(i) + "]"));
    }

    template <int Rows, int Cols>
    Eigen::Matrix<double, Rows, Cols> matrix() const {
        Eigen::Matrix<double, Rows, Cols> result;
        if (!value_.is_array() || value_.size() != std::size_t{Rows} * Cols)
            fail("a list of " + std::to_string(Rows * Cols) + " numbers is expected");
        Eigen::Index k = 0;
        forEach([&](const Node& entry) {
            result(k / Cols, k % Cols) = entry.number();
            ++k;
        });
        return result;
    }

    std::string bytes(std::string_view prefix = {}) const {
        const auto text = as<std::string>();
        if (text.empty()) return {};
        if (!text.starts_with(prefix)) fail("a PNG data URI is expected");
        try {
            return base64Decode(std::string_view(text).substr(prefix.size()));
        } catch (const std::invalid_argument& error) {
            fail(error.what());
        }
    }

    Png png() const { return bytes(kPngPrefix); }

    template <typename T>
    std::vector<T> unpacked() const {
        const std::string content = bytes();
        if (content.size() % sizeof(T) != 0) fail("array is cut");
        std::vector<T> values(content.size() / sizeof(T));
        if (!content.empty())
            std::memcpy(static_cast<void*>(values.data()), content.data(), content.size());
        return values;
    }

    Color color() const {
        const auto text = as<std::string>();
        if (text.size() != 7 || text[0] != '#' ||
            text.find_first_not_of("0123456789abcdef", 1) != std::string::npos)
            fail("a colour #rrggbb is expected");
        const unsigned long rgb = std::stoul(text.substr(1), nullptr, 16);
        return {static_cast<std::uint8_t>(rgb >> 16), static_cast<std::uint8_t>(rgb >> 8 & 255U),
                static_cast<std::uint8_t>(rgb & 255U)};
    }

    [[noreturn]] void fail(const std::string& reason) const {
        throw InputError(file_, key_, reason);
    }

  private:
    const json& value_;
    std::string file_;
    std::string key_;
};

DrawnPath pathFrom(const Node& node) {
    DrawnPath path{node["name"].as<std::string>(), node["color"].color(), {}};
    node["points"].forEach([&](const Node& entry) {
        PathPoint point;
        point.position = entry["position"].matrix<3, 1>();
        point.T_w_c.matrix().topRows<3>() = entry["T_w_c_rows"].matrix<3, 4>();
        point.trace = entry["trace"].number();
        point.positionCovariance = entry["position_covariance"].matrix<3, 3>();
        point.distance = entry["distance"].number();
        point.cost = entry["cost"].number();
        path.points.push_back(point);
    });
    return path;
}

ReportMesh meshFrom(const Node& node) {
    ReportMesh mesh{node["positions"].unpacked<float>(),
                    node["uv"].unpacked<float>(),
                    node["textures"].unpacked<std::uint32_t>(),
                    {}};
    node["images"].forEach([&](const Node& image) { mesh.images.push_back(image.png()); });
    const std::size_t count = mesh.textures.size();
    if (mesh.positions.size() != 9 * count || mesh.uv.size() != 6 * count)
        node.fail("positions, uv and textures disagree on the number of triangles");
    for (const std::uint32_t texture : mesh.textures)
        if (texture >= mesh.images.size()) node["textures"].fail("index outside images");
    return mesh;
}

ReportVoxels voxelsFrom(const Node& node) {
    ReportVoxels voxels{node["centers"].unpacked<float>(), node["grey"].unpacked<std::uint8_t>(),
                        node["size"].number()};
    if (voxels.centers.size() != 3 * voxels.grey.size())
        node.fail("centers and grey disagree on the number of voxels");
    return voxels;
}

void readSearch(const Node& root, ReportData& data) {
    root["trees"].forEach([&](const Node& node) {
        data.trees.push_back({node["name"].as<std::string>(), node["color"].color(),
                              node["edges"].unpacked<Edge>()});
    });
    root["paths"].forEach([&](const Node& node) { data.paths.push_back(pathFrom(node)); });
    root["views"].forEach([&](const Node& node) {
        const auto point = node["point"].as<std::size_t>();
        if (data.paths.empty() || point >= data.paths[0].points.size())
            node["point"].fail("no such point of the first path");
        data.views.push_back({point, node["image"].png(), node["contribution"].png()});
    });
    root["progress"].forEach([&](const Node& node) {
        data.progress.push_back({node["vertices"].as<std::size_t>(), node["seconds"].number(),
                                 node["cost"].number(), node["views"].as<std::size_t>()});
    });
}

void readFiguresAndTables(const Node& root, ReportData& data) {
    const auto readFigures = [&](const char* list, std::vector<ReportFigure>& figures) {
        root[list].forEach([&](const Node& node) {
            figures.push_back({node["caption"].as<std::string>(), node["image"].png()});
        });
    };
    readFigures("figures", data.figures);
    readFigures("frames", data.frames);
    root["tables"].forEach([&](const Node& node) {
        data.tables.push_back(
            {node["title"].as<std::string>(),
             node["rows"].as<std::vector<std::pair<std::string, std::string>>>()});
    });
}

}  // namespace

json toJson(const ReportData& data) {
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
    for (const char* list : {"trees", "paths", "views", "progress", "figures", "frames", "tables"})
        root[list] = json::array();
    for (const DrawnTree& tree : data.trees) root["trees"].push_back(treeToJson(tree));
    for (const DrawnPath& path : data.paths) root["paths"].push_back(pathToJson(path));
    for (const ReportView& view : data.views)
        root["views"].push_back({{"point", view.point},
                                 {"image", dataUri(view.image)},
                                 {"contribution", dataUri(view.contribution)}});
    for (const ReportProgress& step : data.progress)
        root["progress"].push_back({{"vertices", step.vertices},
                                    {"seconds", step.seconds},
                                    {"cost", step.cost},
                                    {"views", step.views}});
    const auto writeFigures = [&](const char* list, const std::vector<ReportFigure>& figures) {
        for (const ReportFigure& figure : figures)
            root[list].push_back({{"caption", figure.caption}, {"image", dataUri(figure.image)}});
    };
    writeFigures("figures", data.figures);
    writeFigures("frames", data.frames);
    for (const ReportTable& table : data.tables)
        root["tables"].push_back({{"title", table.title}, {"rows", table.rows}});
    return root;
}

ReportData readReportData(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        throw InputError(file.string(), "", std::string("cannot be read: ") + std::strerror(errno));
    const json content = json::parse(stream, nullptr, false);
    if (content.is_discarded())
        throw InputError(file.string(), "", "not JSON, or only a part of it");
    const Node root(content, file.string(), "");
    if (root["schema"].as<int>() != kSchema)
        root["schema"].fail("written by another version of photonav");

    ReportData data;
    data.title = root["title"].as<std::string>();
    data.subtitle = root["subtitle"].as<std::string>();
    data.commandLine = root["command_line"].as<std::string>();
    data.version = root["version"].as<std::string>();
    data.result = root["result"].raw();
    data.config = root["config"].as<std::string>();
    data.mesh = meshFrom(root["mesh"]);
    data.voxels = voxelsFrom(root["voxels"]);
    data.start = root["start"].matrix<3, 1>();
    data.goal = root["goal"].matrix<3, 1>();
    data.fieldOfView = root["field_of_view"].matrix<2, 1>();
    readSearch(root, data);
    readFiguresAndTables(root, data);
    return data;
}

}  // namespace photonav
