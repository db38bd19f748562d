// SPDX-License-Identifier: BSD-3-Clause
// Loads a map for tracking from a file.
#pragma once

#include <memory>
#include <string>

#include "map/textured_octree.hpp"
#include "photometry/view.hpp"
#include "scene/scene.hpp"

namespace photonav {

/// Kinds of maps, which differ in the error of their surfaces: a mesh, cells whose surfaces are
/// rendered at the faces of the cell, or cells with a fitted plane inside.
enum class MapKind { mesh, cells, surfaces };

/// Root mean square distance of a map's surfaces to the true ones, for ModelErrors::surface [m].
/// A surface rendered at the face of a cell may truly lie anywhere in the cell: 0.58 cells RMS. A
/// plane inside the cell is fitted to all depths measured there: 0.1 cells for the depth noise of
/// a Kinect (bench/surface_bench).
/// @param cellSize edge of a cell [m]
inline double surfaceError(MapKind kind, double cellSize) {
    if (kind == MapKind::mesh) return 0.;
    return (kind == MapKind::cells ? 0.58 : 0.1) * cellSize;
}

struct TrackingMap {
    std::shared_ptr<const ViewSource> views;       ///< renders the views for the tracker
    std::shared_ptr<const TexturedOcTree> octree;  ///< the map of `views`; null for a mesh
    std::shared_ptr<const Scene> scene;            ///< the mesh of `views`; null for an octree

    MapKind kind = MapKind::mesh;

    /// Edge of the cells [m]; 0 for a mesh.
    double resolution() const { return octree ? octree->getResolution() : 0.; }

    double surfaceError() const { return photonav::surfaceError(kind, resolution()); }
};

/// Loads a textured octree (.ot, .bt), a mesh or a scene file. Unknown cells of an octree are
/// transparent.
/// @throws InputError naming the file
TrackingMap loadTrackingMap(const std::string& file);

}  // namespace photonav
