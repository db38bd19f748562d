// SPDX-License-Identifier: BSD-3-Clause
// Fuses images with depth, and laser scans, into a map.
#pragma once

#include <functional>

#include "io/interrupted.hpp"
#include "map/map_change.hpp"
#include "map/point_cloud.hpp"
#include "map/textured_octree.hpp"

namespace photonav {

struct FusionOptions {
    double minRange = 0.2;  ///< nearer depths are not used [m, along the optical axis]
    double maxRange = 4.0;  ///< farther surfaces are not mapped; space up to this becomes free [m]
    /// Standard deviation of a pixel's depth at 1 m, which grows with depth squared [m]. The
    /// default is typical of structured-light and stereo cameras.
    double depthNoise = 1.5e-3;
    /// Largest relative second difference of inverse depth of a pixel that is used. Beyond it is a
    /// depth edge, where sensors mix two depths.
    double depthJump = 0.05;
    /// Upper limit of the weight of a face [pixels]: its grey value is the mean of about this many
    /// of its latest pixels. They reduce noise from 0.02 to 0.001, and a repainted surface is
    /// updated in about 50 views.
    double maxFaceWeight = 500.;
    // A brick is listed in MapChange::texture if its content may have changed by more than one of
    // these since the brick was last listed.
    double greyTolerance = 0.01;    ///< change of a grey value
    double surfaceTolerance = 0.1;  ///< motion of a surface [cells]
    /// Whether cells store the surfaces inside them; otherwise views show surfaces at the faces of
    /// the cells.
    bool surfaces = true;
    /// Asked for every row of an image, and while the map is changed: fusing a large image, or one
    /// into small cells, takes seconds.
    IsStopped isStopped = {};
};

/// Fuses one image with depth into the map.
///
/// Occupancy: an end cell is a cell that contains the surface point of a pixel. Its occupancy is
/// raised, once per view. The occupancy of every other cell that is crossed by the ray from the
/// camera to the first surface point of an end cell is lowered, once per view. One ray is cast per
/// end cell, not per pixel, because neighbouring rays cross the same cells. If neighbouring pixels
/// of one surface are more than a cell apart (at large distances, at grazing angles and in fine
/// maps), points between them count as pixels in cells without pixels, so that surfaces have no
/// holes. Behind surfaces, and along pixels without depth (not positive, or below minRange),
/// nothing changes: unknown cells stay unknown. A crossed cell that is occupied and has surfaces
/// also stays unchanged, unless the depth image sees through the mean point of each of its
/// surfaces. So a ray at a grazing angle, or close to a surface, does not delete the surface. A
/// crossed cell that is unknown becomes free only if the depth image sees through its centre. The
/// cell of a surface is also crossed in front of the surface, and with errors of the pose from
/// places beside it: were it free there, obstacles would have holes where the image does not show
/// them.
///
/// Surfaces: every pixel has a normal n from the depth image. Along each axis a it counts with
/// weight n_a^2 for the face of its end cell that n points to. If the weights for a face exceed 15
/// % of all weights in the cell, the face observes their mean point and normal (see FaceSurface)
/// and their mean grey value. Point and normal are means over up to three cells before and behind,
/// too, if these are nearer to the same plane than three standard deviations of depth noise, which
/// spreads a surface near the border of two cells over both. All other faces of an end cell that
/// face the camera, and are not covered by another end cell, observe the mean grey value of the
/// cell's pixels. The weight of grey values is (number of pixels) * |n . d|, where n is the normal
/// of the face and d the unit direction from the camera to the cell.
/// @param observed intensity in [0, 1], and depth z in the camera frame [m]
/// @returns what changed
/// @throws std::invalid_argument when image, depth and camera differ in size, the pose is not
///        finite, or the space in view is too large for the map (see maxRange)
/// @throws Interrupted when FusionOptions::isStopped says so; the map has nothing of the image, or,
///         of one that changes more than 65536 bricks of 4 x 4 x 4 cells, a part
MapChange fuse(TexturedOcTree& map, const View& observed, const Camera& camera, const Pose& T_c_w,
               const FusionOptions& options = {});

/// A source of scan points: calls its argument for every point. fuseScan() reads it twice.
using ScanPoints = std::function<void(const std::function<void(const ScanPoint&)>&)>;

/// Fuses a laser scan taken from one position. Occupancy is updated as by fuse(), with the default
/// weights and tolerances of FusionOptions. Scan points have no normals: views show their surfaces
/// at the faces of the cells. Memory grows with the number of cells in the bounding box of the
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
