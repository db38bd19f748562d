// SPDX-License-Identifier: BSD-3-Clause
#include "interchange/drawn_result.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "io/base64.hpp"
#include "io/image_decoder.hpp"

namespace photonav {
namespace {

using nlohmann::json;

constexpr double kMostPoints = 2e5;  // of the surfaces

template <typename Value>
std::vector<Value> valuesIn(const json& text) {
    const std::string bytes = base64Decode(text.get_ref<const std::string&>());
    std::vector<Value> values(bytes.size() / sizeof(Value));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(Value));
    return values;
}

template <int rows, int columns>
Eigen::Matrix<double, rows, columns> matrixIn(const json& list) {
    Eigen::Matrix<double, rows, columns> matrix;
    for (int i = 0; i < rows * columns; ++i) matrix(i / columns, i % columns) = list.at(i);
    return matrix;
}

Color colorIn(const std::string& hex) {
    const unsigned long value = std::stoul(hex.substr(1), nullptr, 16);
    const auto level = [value](unsigned shift) {
        return static_cast<std::uint8_t>(value >> shift & 255U);
    };
    return {level(16), level(8), level(0)};
}

PathPoint pointIn(const json& content) {
    PathPoint point;
    point.position = matrixIn<3, 1>(content.at("position"));
    point.T_w_c.matrix().topRows<3>() = matrixIn<3, 4>(content.at("T_w_c_rows"));
    point.positionCovariance = matrixIn<3, 3>(content.at("position_covariance"));
    const json& trace = content.at("trace");
    point.trace = trace.is_null() ? NAN : trace.get<double>();
    point.distance = content.at("distance");
    return point;
}

cv::Mat textureIn(const std::string& dataUri) {
    const std::string bytes = base64Decode(std::string_view(dataUri).substr(dataUri.find(',') + 1));
    const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());
    return decodedImage({first, bytes.size()}, cv::IMREAD_GRAYSCALE,
                        [](const ImageSize&) { return true; });
}

/// The grey value at (u, v) of a texture that repeats; v downward.
std::uint8_t greyAt(const cv::Mat& texture, double u, double v) {
    if (texture.empty()) return 128;
    const auto index = [](double share, int size) {
        return std::min(static_cast<int>((share - std::floor(share)) * size), size - 1);
    };
    return texture.at<std::uint8_t>(index(v, texture.rows), index(u, texture.cols));
}

/// Triangles as they are packed in a report.
struct Triangles {
    std::vector<float> positions, uv;
    std::vector<std::uint32_t> textures;
    std::vector<cv::Mat> images;

    Eigen::Vector3d corner(std::size_t i, std::size_t k) const {
        return Eigen::Vector3f(&positions[9 * i + 3 * k]).cast<double>();
    }
    Eigen::Vector2d at(std::size_t i, std::size_t k) const {
        return Eigen::Vector2f(&uv[6 * i + 2 * k]).cast<double>();
    }
    double area(std::size_t i) const {
        return 0.5 * (corner(i, 1) - corner(i, 0)).cross(corner(i, 2) - corner(i, 0)).norm();
    }
};

/// @throws std::invalid_argument for lists that do not belong together
void checkNumbers(const Triangles& mesh) {
    const std::size_t count = mesh.textures.size();
    if (mesh.positions.size() != 9 * count || mesh.uv.size() != 6 * count) {
        throw std::invalid_argument("mesh: positions, uv and textures differ in number");
    }
    const auto isMissing = [&](std::uint32_t texture) { return texture >= mesh.images.size(); };
    if (std::ranges::any_of(mesh.textures, isMissing)) {
        throw std::invalid_argument("mesh: a triangle whose texture is not among the images");
    }
}

/// Points of a triangle in rows along its sides, `spacing` [m] apart.
void addPoints(const Triangles& mesh, std::size_t i, double spacing, GreyPoints& points) {
    const Eigen::Vector3d a = mesh.corner(i, 0), b = mesh.corner(i, 1) - a,
                          c = mesh.corner(i, 2) - a;
    const Eigen::Vector2d at = mesh.at(i, 0), atB = mesh.at(i, 1) - at, atC = mesh.at(i, 2) - at;
    const cv::Mat& texture = mesh.images[mesh.textures[i]];
    const int rows = std::max(1, static_cast<int>(b.norm() / spacing));
    for (int row = 0; row < rows; ++row) {
        const double s = (row + 0.5) / rows;
        const int columns = std::max(1, static_cast<int>((1. - s) * c.norm() / spacing));
        for (int column = 0; column < columns; ++column) {
            const double t = (1. - s) * (column + 0.5) / columns;
            const Eigen::Vector2d uv = at + s * atB + t * atC;
            points.add((a + s * b + t * c).cast<float>(), greyAt(texture, uv.x(), uv.y()));
        }
    }
}

void addSurfaces(const json& mesh, GreyPoints& points) {
    Triangles triangles{valuesIn<float>(mesh.at("positions")),
                        valuesIn<float>(mesh.at("uv")),
                        valuesIn<std::uint32_t>(mesh.at("textures")),
                        {}};
    triangles.images.reserve(mesh.at("images").size());
    for (const json& image : mesh.at("images")) {
        triangles.images.push_back(textureIn(image.get<std::string>()));
    }
    checkNumbers(triangles);
    double area = 0.;
    for (std::size_t i = 0; i < triangles.textures.size(); ++i) area += triangles.area(i);
    if (!(area > 0.) || !std::isfinite(area)) return;
    for (std::size_t i = 0; i < triangles.textures.size(); ++i) {
        addPoints(triangles, i, std::sqrt(area / kMostPoints), points);
    }
}

}  // namespace

std::vector<DrawnPath> drawnPaths(const json& report) {
    std::vector<DrawnPath> paths;
    for (const json& content : report.at("paths")) {
        DrawnPath& path = paths.emplace_back();
        path.name = content.at("name");
        path.color = colorIn(content.at("color"));
        const json& points = content.at("points");
        path.points.reserve(points.size());
        for (const json& point : points) path.points.push_back(pointIn(point));
    }
    return paths;
}

GreyPoints drawnSurroundings(const json& report) {
    const json& voxels = report.at("voxels");
    GreyPoints points{valuesIn<float>(voxels.at("centers")),
                      valuesIn<std::uint8_t>(voxels.at("grey"))};
    if (points.positions.size() != 3 * points.grey.size()) {
        throw std::invalid_argument("voxels and their grey values differ in number");
    }
    addSurfaces(report.at("mesh"), points);
    return points;
}

}  // namespace photonav
