// SPDX-License-Identifier: BSD-3-Clause
// Views of a map without the surfaces that a depth image does not find there.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "geometry/uncertain_pose.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// How well depth images and the surfaces of a map are known.
struct DepthAccuracy {
    double sigmaAtOneMetre = 0.;  ///< of measured depth; it grows with depth squared [m]
    double ofMap = 0.;            ///< error of the map's surfaces, such as an edge of a cell [m]
};

/// Views of a map that is not complete: where a surface is not in the map yet, or was moved, a ray
/// goes on to whatever is behind it, and the view shows what the camera does not see. Where the
/// camera measures depth, such pixels are found and count as pixels without a surface.
class MeasuredSurfaces : public ViewSource {
  public:
    MeasuredSurfaces(std::shared_ptr<const ViewSource> map, const DepthAccuracy& accuracy);

    /// Compares a view of the map with measured depth. A pixel is contradicted if its measured
    /// depth is outside the range of depths that the view has within three standard deviations of
    /// the pose; pixels without measured depth are not contradicted. Replaces the result of the
    /// measurement before.
    /// @param expected view of the map from the mean of `T_c_w`
    /// @param measured depth image [m], 0: not measured; empty: no pixel is contradicted
    /// @throws std::invalid_argument for a depth image of another size than the view
    void measure(const View& expected, const ImageF& measured, const Camera& camera,
                 const UncertainPose& T_c_w);
    /// The same, with a view of the map that is rendered for it.
    void measure(const ImageF& measured, const Camera& camera, const UncertainPose& T_c_w);

    /// A view of the map without depth at the contradicted pixels. Cameras may be halved versions
    /// of the measurement's.
    void render(const Camera& camera, const Pose& T_c_w, View& view) const override;

  private:
    struct Pixel {
        unsigned u, v;
    };
    std::shared_ptr<const ViewSource> map_;
    DepthAccuracy accuracy_;
    std::vector<Pixel> contradicted_;
    unsigned width_ = 0;  // of the measurement
};

}  // namespace photonav
