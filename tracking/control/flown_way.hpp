// SPDX-License-Identifier: BSD-3-Clause
// The way back to where the pose was known.
#pragma once

#include <vector>

#include "control/route.hpp"

namespace photonav {

/// Body poses since the last view that determined the pose, as they were believed. Nothing stood on
/// the way that was flown; a straight line back may lead through a wall.
class FlownWay {
  public:
    /// The body has moved on.
    /// @param T_w_certain pose of the body at the last view that determined it: a new one begins
    /// the way anew
    void moved(const Pose& T_w_b, const Pose& T_w_certain);

    /// From where the body is now to where the way begins, with the headings on the way.
    std::vector<PlannedView> back() const;
    double length() const;  ///< [m]

  private:
    std::vector<Pose> poses_;
    Pose now_ = Pose::Identity();
};

}  // namespace photonav
