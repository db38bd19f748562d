// SPDX-License-Identifier: BSD-3-Clause
// The pixels of a sensor, which average the light over their area.
#pragma once

#include "photometry/view.hpp"

namespace photonav {

/// Views as a sensor takes them: the mean of `samples` x `samples` rays per pixel. The depth is
/// that of one of the rays next to the pixel's centre. The point spread is that of a square pixel,
/// 1 / sqrt(12) pixels, where a renderer filters its textures more (kRenderedSpread).
class AreaSensor : public ViewSource {
  public:
    /// @param world must outlive this @throws std::invalid_argument for less than one sample
    explicit AreaSensor(const ViewSource& world, unsigned samples = 3);

    void render(const Camera& camera, const Pose& T_c_w, View& view) const override;

  private:
    const ViewSource& world_;
    unsigned samples_;
};

}  // namespace photonav
