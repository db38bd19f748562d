// SPDX-License-Identifier: BSD-3-Clause
// Where the camera is while it flies: odometry between images, alignment at each.
#pragma once

#include "dense_aligner.hpp"

namespace photonav {

/// The belief T_c_w = exp(xi^) mean, xi ~ N(0, covariance) in the camera frame: propagated and
/// updated by the functions that the planner predicts with.
class PoseFilter {
  public:
    explicit PoseFilter(const UncertainPose& start,
                        PropagationOrder order = PropagationOrder::fourth)
        : belief_(start), order_(order) {}

    /// The camera has moved.
    /// @param T_next_now measured motion and its covariance, in the new camera frame
    void propagate(const UncertainPose& T_next_now) {
        belief_ = compound(T_next_now, belief_, order_);
    }

    /// An image was taken. The belief takes the result unless the alignment is lost, when it stays
    /// as it was and goes on growing with the motion.
    Alignment update(DenseAligner& aligner, const ImageF& observed) {
        Alignment alignment = aligner.align(observed, belief_);
        if (!isLost(alignment.verdict)) belief_ = {alignment.T_c_w, alignment.covariance};
        return alignment;
    }

    const UncertainPose& belief() const { return belief_; }

  private:
    UncertainPose belief_;
    PropagationOrder order_;
};

}  // namespace photonav
