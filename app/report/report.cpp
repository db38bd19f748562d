// SPDX-License-Identifier: BSD-3-Clause
#include "report/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string_view>

#include "io/atomic_file.hpp"
#include "recording/image_file.hpp"

namespace photonav {

/// app/report/page and its libraries in one piece, made by cmake/embed_report.cmake.
extern const std::string_view kReportPage;

namespace {

constexpr std::string_view kDataMark = "@PHOTONAV_DATA@";

/// JSON inside <script>: no '<' may be left that could end or open an element.
std::string escapedForScript(std::string_view text) {
    std::string escaped;
    escaped.reserve(text.size());
    for (const char character : text)
        if (character == '<')
            escaped += "\\u003c";
        else
            escaped += character;
    return escaped;
}

struct VoxelSum {
    Eigen::Vector3d center;
    double grey = 0.0;
    double count = 0.0;
};

/// Mean grey value of the voxels in each cell of a grid of edge length `size`.
ReportVoxels coarsened(const std::vector<Eigen::Vector3f>& centers,
                       const std::vector<std::uint8_t>& grey, double size) {
    std::map<std::array<long, 3>, VoxelSum> cells;
    for (std::size_t i = 0; i < centers.size(); ++i) {
        const Eigen::Vector3d cell = (centers[i].cast<double>() / size).array().floor();
        VoxelSum& sum =
            cells[{std::lround(cell.x()), std::lround(cell.y()), std::lround(cell.z())}];
        sum.center = (cell.array() + 0.5) * size;
        sum.grey += grey[i];
        sum.count += 1.0;
    }
    ReportVoxels voxels;
    voxels.size = size;
    for (const auto& [index, sum] : cells) {
        for (int k = 0; k < 3; ++k) voxels.centers.push_back(static_cast<float>(sum.center[k]));
        voxels.grey.push_back(static_cast<std::uint8_t>(std::lround(sum.grey / sum.count)));
    }
    return voxels;
}

}  // namespace

ReportMesh makeReportMesh(const Scene& scene) {
    ReportMesh mesh;
    for (const Texture& texture : scene.textures) mesh.images.push_back(greyPng(texture.image));
    for (const Triangle& triangle : scene.triangles) {
        for (const Eigen::Vector3f& corner : triangle.corners)
            mesh.positions.insert(mesh.positions.end(), corner.data(), corner.data() + 3);
        for (const Eigen::Vector2f& uv : triangle.uv)
            mesh.uv.insert(mesh.uv.end(), uv.data(), uv.data() + 2);
        mesh.textures.push_back(triangle.texture);
    }
    return mesh;
}

ReportVoxels makeReportVoxels(const std::vector<Eigen::Vector3f>& centers,
                              const std::vector<std::uint8_t>& grey, double size,
                              std::size_t limit) {
    if (centers.size() != grey.size() || size <= 0.0)
        throw std::invalid_argument("makeReportVoxels: one grey value per voxel of positive size");
    ReportVoxels voxels{{}, grey, size};
    for (const Eigen::Vector3f& center : centers)
        voxels.centers.insert(voxels.centers.end(), center.data(), center.data() + 3);
    while (voxels.grey.size() > limit) voxels = coarsened(centers, grey, size *= 2.0);
    return voxels;
}

Eigen::Vector2d fieldOfView(const Camera& camera) {
    return {2. * std::atan(0.5 * camera.width / camera.fx()),
            2. * std::atan(0.5 * camera.height / camera.fy())};
}

ReportVoxels makeReportVoxels(const TexturedOcTree& map) {
    std::vector<Eigen::Vector3f> centers;
    std::vector<std::uint8_t> grey;
    const double size = map.getResolution();
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        if (!map.isNodeOccupied(*leaf)) continue;
        const std::uint8_t level = greyLevel(leaf->meanGrey().value_or(0.5F));
        const int cells = static_cast<int>(std::lround(leaf.getSize() / size));  // of a pruned leaf
        const Eigen::Vector3d corner(leaf.getX(), leaf.getY(), leaf.getZ());
        for (int z = 0; z < cells; ++z)
            for (int y = 0; y < cells; ++y)
                for (int x = 0; x < cells; ++x) {
                    const Eigen::Array3d cell = Eigen::Array3d(x, y, z) + 0.5 - 0.5 * cells;
                    centers.emplace_back((corner.array() + size * cell).cast<float>());
                    grey.push_back(level);
                }
    }
    return makeReportVoxels(centers, grey, size);
}

void writeReport(const std::filesystem::path& file, std::string_view content) {
    const std::size_t mark = kReportPage.find(kDataMark);
    std::string page(kReportPage.substr(0, mark));
    page += escapedForScript(content);
    page += kReportPage.substr(mark + kDataMark.size());
    writeFileAtomically(file, page);
}

void writeResultFolder(const std::filesystem::path& folder, ReportData& report,
                       const std::vector<NamedFigure>& figures) {
    for (const NamedFigure& named : figures) {
        writeFileAtomically(folder / named.name, named.figure.image);
        report.figures.push_back(named.figure);
    }
    if (!report.config.empty()) writeFileAtomically(folder / "config.yaml", report.config);
    const std::string text = reportJson(report);
    writeFileAtomically(folder / "report.json", text);
    writeReport(folder / "report.html", text);
}

}  // namespace photonav
