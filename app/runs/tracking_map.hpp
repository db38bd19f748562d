// SPDX-License-Identifier: BSD-3-Clause
// A map to track in, from a file.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "map/textured_octree.hpp"
#include "photometry/view.hpp"
#include "report/report.hpp"

namespace photonav {

struct TrackingMap {
    std::shared_ptr<TexturedOcTree> octree;   ///< none: a mesh
    std::shared_ptr<const ViewSource> views;  ///< what images are compared with
    std::function<void(ReportData&)> describe = [](ReportData&) {};

    /// Size of its cells [m]; 0: a mesh.
    double resolution() const { return octree ? octree->getResolution() : 0.; }
};

/// A textured octree (.ot, .bt), in which unknown cells hide nothing, a mesh or a scene file.
/// @throws InputError naming the file
TrackingMap loadTrackingMap(const std::string& file);

}  // namespace photonav
