// SPDX-License-Identifier: BSD-3-Clause
// A map to track in, from a file.
#pragma once

#include <memory>
#include <string>

#include "map/textured_octree.hpp"
#include "photometry/view.hpp"
#include "scene/scene.hpp"

namespace photonav {

/// What decides how far images of a model err: a mesh, cells whose surfaces are seen at their
/// faces, or cells with surfaces inside.
enum class MapKind { mesh, cells, surfaces };

/// Root mean square distance of a map's surfaces to the true ones, for ModelErrors::surface [m].
/// Seen at the face of a cell, a surface lies anywhere in it: 0.58 cells away. A plane inside of it
/// is made of all depths seen there: 0.1 cells for depth as a Kinect measures it
/// (bench/surface_bench).
inline double surfaceError(MapKind kind, double cellSize) {
    if (kind == MapKind::mesh) return 0.;
    return (kind == MapKind::cells ? 0.58 : 0.1) * cellSize;
}

struct TrackingMap {
    std::shared_ptr<const ViewSource> views;       ///< what images are compared with
    std::shared_ptr<const TexturedOcTree> octree;  ///< that they are views of, or
    std::shared_ptr<const Scene> scene;            ///< a mesh

    MapKind kind = MapKind::mesh;

    /// Size of its cells [m]; 0: a mesh.
    double resolution() const { return octree ? octree->getResolution() : 0.; }

    double surfaceError() const { return photonav::surfaceError(kind, resolution()); }
};

/// A textured octree (.ot, .bt), in which unknown cells hide nothing, a mesh or a scene file.
/// @throws InputError naming the file
TrackingMap loadTrackingMap(const std::string& file);

}  // namespace photonav
