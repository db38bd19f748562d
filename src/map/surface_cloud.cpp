// SPDX-License-Identifier: BSD-3-Clause
#include "map/surface_cloud.hpp"

#include <bit>
#include <ostream>
#include <vector>

#include "io/atomic_file.hpp"
#include "photometry/view.hpp"

namespace photonav {
namespace {

static_assert(std::endian::native == std::endian::little);

struct SurfacePoint {
    std::array<float, 3> position, normal;
    std::array<std::uint8_t, 3> colour;
};

/// Whether a normal is longest along the axis of a face: a slanted surface is observed through two
/// or three faces, and belongs to one of them.
bool belongsTo(const Eigen::Vector3f& normal, unsigned face) {
    int axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    return axis == static_cast<int>(face / 2);
}

void addPoints(const TexturedOcTreeNode& leaf, const octomap::point3d& centre, double resolution,
               std::vector<SurfacePoint>& points) {
    const float grey = leaf.meanGrey().value_or(0.5F);
    for (unsigned f = 0; f < 6; ++f) {
        const FaceSurface& surface = leaf.surfaces[f];
        const Eigen::Vector3f n = surface.meanNormal();
        if (!surface.observed() || n.isZero() || !belongsTo(n, f)) continue;
        const Eigen::Vector3f p = Eigen::Vector3f(centre.x(), centre.y(), centre.z()) +
                                  static_cast<float>(resolution) * surface.meanPoint();
        const Eigen::Vector3f unit = n.normalized();
        const FaceTexture& face = leaf.faces[f];
        const std::uint8_t level = greyLevel(face.observed() ? face.mean : grey);
        points.push_back(
            {{p.x(), p.y(), p.z()}, {unit.x(), unit.y(), unit.z()}, {level, level, level}});
    }
}

}  // namespace

void saveSurfaceCloud(const TexturedOcTree& map, const std::string& file) {
    std::vector<SurfacePoint> points;
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        if (leaf->surfaces.empty() || !map.isNodeOccupied(*leaf)) continue;
        addPoints(*leaf, leaf.getCoordinate(), leaf.getSize(), points);
    }
    writeFileAtomically(file, [&](std::ostream& stream) {
        stream << "ply\nformat binary_little_endian 1.0\ncomment surfaces of a photonav map\n"
               << "element vertex " << points.size() << "\n";
        for (const char* name : {"x", "y", "z", "nx", "ny", "nz"})
            stream << "property float " << name << "\n";
        for (const char* name : {"red", "green", "blue"})
            stream << "property uchar " << name << "\n";
        stream << "end_header\n";
        for (const SurfacePoint& point : points) {
            stream.write(reinterpret_cast<const char*>(&point), 27);  // without its padding
        }
    });
}

}  // namespace photonav
