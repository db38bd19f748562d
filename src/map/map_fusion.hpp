// SPDX-License-Identifier: BSD-3-Clause
// An image with depth becomes part of the map.
#pragma once

#include <functional>

#include "map/map_change.hpp"
#include "map/point_cloud.hpp"
#include "map/textured_octree.hpp"

namespace photonav {

struct FusionOptions {
    double minRange = 0.2;  ///< nearer depths are not trusted [m], along the optical axis
    double maxRange = 4.0;  ///< farther surfaces are not mapped; space up to this becomes free [m]
    double depthJump = 0.05;  ///< a relative second difference of inverse depth above this is a
                              ///< depth edge, where sensors mix two depths: the pixel is not used
    double maxFaceWeight = 500.;  ///< a face's grey value is the mean of about this many of its
                                  ///< latest pixels: enough to reduce noise from 0.02 to 0.001, few
                                  ///< enough to learn a repainted surface in about 50 views
    double greyTolerance = 0.01;  ///< a brick is listed in MapChange::texture when a grey value in
                                  ///< it may have changed by more since the brick was last listed,
    double surfaceTolerance = 0.1;  ///< or when a surface in it may have moved by more [cells]
    bool surfaces = true;  ///< cells learn where the surface lies in them: without, views show it
                           ///< at the faces of its cells
};

/// Fuses one observation into the map.
///
/// Ray policy: in every cell that contains the surface point of a pixel (an end cell), occupancy is
/// raised, once per view. In every other cell that is crossed by the ray from the camera to the
/// first such point, occupancy is lowered, once per view. One ray is cast per end cell, not per
/// pixel, because neighbouring rays cross the same cells. A cell that is both crossed and an end is
/// treated as an end. Where neighbouring pixels of one surface are more than a cell apart, as far
/// away, at grazing angles and in fine maps, the points between them count as pixels in cells that
/// no pixel ends in: surfaces have no holes. Behind surfaces, and along pixels without depth (not
/// positive, or below minRange), nothing changes: unknown cells stay unknown. An occupied cell with
/// surfaces stays as it is, too, where rays pass by them: unless some image point shows through the
/// mean point of every surface. So a ray that arrives at a grazing angle, or passes close by, does
/// not delete the surface next to it.
///
/// Surfaces: every pixel has a normal n from the depth image, and counts with n_a^2 for the face of
/// its end cell that n points to along each axis a. Where these are at least 15 % of the cell's
/// pixels, the face observes their mean point and normal (see FaceSurface) and their mean grey
/// value. All other faces of an end cell that look toward the camera, and are not covered by
/// another end cell, observe the mean grey value of the cell's pixels. The weight of grey values is
/// (pixels) * |n . d|, where n is the face's normal and d the direction from the camera to the
/// cell.
/// @returns what changed
/// @throws std::invalid_argument when image, depth and camera differ in size, the pose is not
///        finite, or the space in view is too large for the map (see maxRange)
MapChange fuse(TexturedOcTree& map, const View& observed, const Camera& camera, const Pose& T_c_w,
               const FusionOptions& options = {});

/// A source of scan points: calls its argument for every point. fuseScan() calls it twice.
using ScanPoints = std::function<void(const std::function<void(const ScanPoint&)>&)>;

/// Fuses a laser scan taken from one position, with the same ray policy and the default weights and
/// tolerance of FusionOptions. Scan points have no normals: views show their surfaces at the faces
/// of the cells. Memory grows with the number of cells in the bounding box of the
/// points, not with the number of points.
/// @param scanner position of the scanner, world frame [m]. Without it no cell becomes free, and
///        every face of an end cell that no other end cell covers observes the mean of the cell's
///        points.
/// @param maxRange farther points are not mapped; the space up to this becomes free [m]
/// @returns what changed
/// @throws std::invalid_argument when the box of the points is too large for the map's cells
MapChange fuseScan(TexturedOcTree& map, const ScanPoints& points,
                   const std::optional<Eigen::Vector3d>& scanner, double maxRange);

}  // namespace photonav
