// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/real_time_monitor.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace photonav {

Durations summaryOf(std::vector<double> durations) {
    if (durations.empty()) return {};
    std::sort(durations.begin(), durations.end());
    const std::size_t last = durations.size() - 1;
    return {durations.size(), durations[durations.size() / 2],
            durations[(durations.size() * 95 + 99) / 100 - 1], durations[last]};
}

void RealTimeMonitor::onArrival(double time) {
    arrival_ = watch_.seconds();
    offset_ = std::min(offset_.value_or(arrival_ - time), arrival_ - time);
    lateness_.push_back(arrival_ - time - *offset_);
}

void RealTimeMonitor::onAnswer(double imageTime) {
    exposureToAnswer_.push_back(now() - imageTime);
    arrivalToAnswer_.push_back(watch_.seconds() - arrival_);
}

void RealTimeMonitor::onPlan(double imageTime, bool isEndedByClock) {
    planAge_.push_back(now() - imageTime);
    endedByClock_ += isEndedByClock ? 1 : 0;
}

RealTimeSummary RealTimeMonitor::summary() const {
    RealTimeSummary summary;
    summary.lateness = summaryOf(lateness_);
    summary.lateSteps = static_cast<std::size_t>(
        std::count_if(lateness_.begin(), lateness_.end(), [](double s) { return s > kLate; }));
    summary.exposureToAnswer = summaryOf(exposureToAnswer_);
    summary.arrivalToAnswer = summaryOf(arrivalToAnswer_);
    summary.planAge = summaryOf(planAge_);
    summary.endedByClock = endedByClock_;
    return summary;
}

/// A simulated robot is computed in the time in which it flies. A step that is late is followed by
/// the next one at once.
Observation RealTimeRobot::fly(const BodyVelocity& command, double seconds) {
    Observation observation = robot_.fly(command, seconds);
    if (!watch_) watch_.emplace();
    due_ += seconds;
    const double early = due_ - watch_->seconds();
    if (clock_ == Clock::wall && early > 0.) {
        std::this_thread::sleep_for(std::chrono::duration<double>(early));
    }
    monitor_.onArrival(observation.time);
    return observation;
}

}  // namespace photonav
