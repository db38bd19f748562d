// SPDX-License-Identifier: BSD-3-Clause
#include "flight_estimator.hpp"

#include <utility>

#include "se3.hpp"

namespace photonav {

FlightEstimator::FlightEstimator(const UncertainPose& start, const Pose& T_b_c)
    : filter_(start), T_c_b_(T_b_c.inverse()), toCamera_(adjoint(T_c_b_)) {}

void FlightEstimator::move(const UncertainPose& T_next_now) {
    const UncertainPose camera{T_c_b_ * T_next_now.mean * T_c_b_.inverse(),
                               toCamera_ * T_next_now.covariance * toCamera_.transpose()};
    open_ = compound(camera, open_, PropagationOrder::second);  // of a few steps: tiny
}

void FlightEstimator::expose(double time) { closed_.push_back({time, std::exchange(open_, {})}); }

Alignment FlightEstimator::receive(WideAligner& aligner, double exposureTime, const ImageF& image) {
    while (!closed_.empty() && closed_.front().end <= exposureTime) {
        filter_.propagate(closed_.front().T_next_now);
        closed_.pop_front();
    }
    const Alignment alignment = aligner.align(image, filter_.belief());
    if (!isLost(alignment.verdict)) reset({alignment.T_c_w, alignment.covariance});
    return alignment;
}

UncertainPose FlightEstimator::belief() const {
    UncertainPose belief = filter_.belief();
    for (const Segment& segment : closed_) belief = compound(segment.T_next_now, belief);
    return compound(open_, belief);
}

}  // namespace photonav
