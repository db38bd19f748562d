// SPDX-License-Identifier: BSD-3-Clause
// How well a flight in real time keeps its times.
#pragma once

#include <optional>
#include <vector>

#include "io/stopwatch.hpp"
#include "robot/robot.hpp"

namespace photonav {

/// Median, 95 % quantile and largest of a number of durations [s]; 0 without any.
struct Durations {
    std::size_t count = 0;
    double median = 0., quantile95 = 0., worst = 0.;
};
Durations summaryOf(std::vector<double> durations);

/// What a flight in real time missed.
struct RealTimeSummary {
    Durations lateness;         ///< of the control steps, behind their time
    std::size_t lateSteps = 0;  ///< late by more than RealTimeMonitor::kLate
    /// From the exposure of an image with depth, and from its arrival, to the answer whether the
    /// way ahead is free.
    Durations exposureToAnswer, arrivalToAnswer;
    Durations planAge;  ///< from the exposure of its last image until a plan took effect
    /// Updates of the plan: begun late because the second thread was busy; of these, joined to an
    /// earlier one; not improved further because the time was over.
    std::size_t waited = 0, joined = 0, endedByClock = 0;
};

/// Measures a flight in real time. The clock of the robot (Observation::time) is compared with the
/// wall clock: what arrived with the least delay so far counts as in time.
class RealTimeMonitor {
  public:
    static constexpr double kLate = 2e-3;  ///< a control step begun later than this is late [s]

    /// Call it when measurements of a step arrive. @param time of the step by the robot's clock [s]
    void onArrival(double time);
    /// Call it when the way ahead was tested. @param imageTime time of the exposure [s]
    void onAnswer(double imageTime);
    /// Call it when a plan takes effect. @param imageTime time of the last image in it [s]
    void onPlan(double imageTime, bool isEndedByClock);

    /// Everything but RealTimeSummary::waited and joined.
    RealTimeSummary summary() const;

  private:
    double now() const { return watch_.seconds() - offset_.value_or(0.); }

    Stopwatch watch_;
    std::optional<double> offset_;  // from the robot's clock to the wall clock [s]
    double arrival_ = 0.;           // of the last step, by the wall clock [s]
    std::vector<double> lateness_, exposureToAnswer_, arrivalToAnswer_, planAge_;  // [s]
    std::size_t endedByClock_ = 0;
};

/// Another robot in real time.
class RealTimeRobot : public Robot {
  public:
    /// The clock that paces a flight: a second of flight takes a second.
    enum class Clock {
        robot,  ///< fly() of the other robot does
        wall,   ///< this class waits; the other robot is simulated
    };
    /// @param robot,monitor must outlive this object
    RealTimeRobot(Robot& robot, Clock clock, RealTimeMonitor& monitor)
        : robot_(robot), clock_(clock), monitor_(monitor) {}

    Observation fly(const BodyVelocity& command, double seconds) override;
    const Camera& camera() const override { return robot_.camera(); }
    const Pose& T_b_c() const override { return robot_.T_b_c(); }
    double blur() const override { return robot_.blur(); }

  private:
    Robot& robot_;
    Clock clock_;
    RealTimeMonitor& monitor_;
    std::optional<Stopwatch> watch_;  // since the first step
    double due_ = 0.;                 // time of the step [s]
};

}  // namespace photonav
