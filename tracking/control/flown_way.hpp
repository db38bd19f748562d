// SPDX-License-Identifier: BSD-3-Clause
// The way back to the last view that determined the pose.
#pragma once

#include <vector>

#include "control/route.hpp"

namespace photonav {

/// The believed body poses since the last view that determined the pose. The way that was flown is
/// free of obstacles; a straight line back may lead through a wall.
class FlownWay {
  public:
    /// Adds a body pose.
    /// @param T_w_certain pose of the body at the last view that determined the pose; if it is a
    ///        new one, the way begins there
    void moved(const Pose& T_w_b, const Pose& T_w_certain);

    /// The plan from the present pose to the beginning of the way, with the headings of the way.
    std::vector<PlannedView> back() const;
    double length() const;  ///< [m]

  private:
    std::vector<Pose> poses_;
    Pose now_ = Pose::Identity();
};

}  // namespace photonav
