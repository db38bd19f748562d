// SPDX-License-Identifier: BSD-3-Clause
// An image with depth becomes part of the map.
#pragma once

#include <functional>

#include "map/map_change.hpp"
#include "map/point_cloud.hpp"
#include "map/textured_octree.hpp"

namespace photonav {

struct FusionOptions {
    double minRange = 0.2;    ///< nearer depths are not trusted [m], along the optical axis
    double maxRange = 4.0;    ///< farther surfaces are not entered; the space up to it is free [m]
    double depthJump = 0.05;  ///< a relative second difference of inverse depth above this is a
                              ///< depth edge, where sensors smear: the pixel is dropped
    double maxFaceWeight = 500.;  ///< a face's grey is the mean of about its last so many pixels:
                                  ///< enough to average noise (of 0.02 to 0.001), few enough that a
                                  ///< surface that was painted anew is learned in some 50 views
    double greyTolerance = 0.01;  ///< a brick's texture counts as changed when a grey value in it
                                  ///< may have moved by more since the brick was reported last
};

/// Fuses one observation into the map.
///
/// Ray policy: every cell that holds the surface point of a pixel becomes more occupied, once per
/// view; every other cell that the ray from the camera to the first such point crosses becomes more
/// free, once per view. One ray per end cell is cast, not one per pixel (neighbouring rays cross
/// the same cells); where a cell is both end and crossed, the end counts. Behind surfaces, and
/// along pixels without depth (not positive, or below minRange), nothing changes: unknown cells
/// stay unknown.
///
/// The faces of an end cell that look toward the camera, and are not covered by another end cell,
/// take the mean grey value of the cell's pixels with weight (pixels) * |n . d|, n the face's
/// normal and d the direction from the camera to the cell.
/// @returns what changed
/// @throws std::invalid_argument when image, depth and camera differ in size, the pose is not
///         finite, or the space in view is too large for the map (see maxRange)
MapChange fuse(TexturedOcTree& map, const View& observed, const Camera& camera, const Pose& T_c_w,
               const FusionOptions& options = {});

/// Calls the function it is given for every point of a scan; it is asked to do so twice.
using ScanPoints = std::function<void(const std::function<void(const ScanPoint&)>&)>;

/// Fuses what a laser scanner saw from one place, by the same ray policy, and with the defaults of
/// FusionOptions for weights and tolerance. Memory is that of the cells in the points' bounding
/// box, however many points there are.
/// @param scanner where it stood, world frame [m]. Without it nothing becomes free, and all faces
///        of a cell that no other cell covers take its points' mean.
/// @param maxRange farther points are not entered; the space up to them is free [m]
/// @returns what changed
/// @throws std::invalid_argument when the box of the points is too large for the map's cells
MapChange fuseScan(TexturedOcTree& map, const ScanPoints& points,
                   const std::optional<Eigen::Vector3d>& scanner, double maxRange);

}  // namespace photonav
