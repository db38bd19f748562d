// SPDX-License-Identifier: BSD-3-Clause
// The pixels of a sensor, which average the light over their area.
#pragma once

#include "photometry/view.hpp"

namespace photonav {

/// Point spread of a pixel that averages over its area, 1 / sqrt(12): standard deviation [pixels].
inline constexpr double kAreaBlur = 0.2887;

/// Views as a sensor takes them: the mean of `samples` x `samples` rays per pixel. The depth is
/// that of one of the rays next to the pixel's centre. The point spread is kAreaBlur and that of a
/// ray, where a rendered view's is more than twice as wide.
class AreaSensor : public ViewSource {
  public:
    /// @param world must outlive this @throws std::invalid_argument for less than one sample
    explicit AreaSensor(const ViewSource& world, unsigned samples = 3);

    void render(const Camera& camera, const Pose& T_c_w, View& view) const override;

  private:
    void renderAtOnce(const Camera& camera, const Pose& T_c_w, View& view) const;

    const ViewSource& world_;
    unsigned samples_;
};

}  // namespace photonav
