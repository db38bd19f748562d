// SPDX-License-Identifier: BSD-3-Clause
// Views of a sensor whose pixels average the light over their area.
#pragma once

#include "photometry/view.hpp"

namespace photonav {

/// Point spread of a pixel that averages over its area, 1 / sqrt(12): standard deviation [pixels].
inline constexpr double kAreaBlur = 0.2887;

/// Simulates a sensor: the grey value of a pixel is the mean over `samples` x `samples` rays, its
/// depth is the depth of a ray nearest to the pixel's centre. The point spread is kAreaBlur,
/// widened by the point spread of a single ray; a rendered view has more than twice as wide a
/// spread.
class AreaSensor : public ViewSource {
  public:
    /// @param world must outlive this object
    /// @param samples number of rays per pixel along each axis
    /// @throws std::invalid_argument for less than one sample
    explicit AreaSensor(const ViewSource& world, unsigned samples = 3);

    void render(const Camera& camera, const Pose& T_c_w, View& view) const override;

  private:
    void renderAtOnce(const Camera& camera, const Pose& T_c_w, View& view) const;

    const ViewSource& world_;
    unsigned samples_;
};

}  // namespace photonav
