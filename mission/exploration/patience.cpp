// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/patience.hpp"

namespace photonav {
namespace {

constexpr int kMostWithoutWay = 6;       // updates
constexpr double kLeastWithoutWay = 2.;  // at whatever rate images come [s]
constexpr double kLongestStop = 10.;     // [s]
constexpr double kLongestAtGoal = 30.;   // [s]
constexpr double kAroundGoal = 2.;       // distance to the goal [m]

}  // namespace

void Patience::onWay(bool isStopped, double time) {
    withoutWay_ = 0;
    withoutWaySince_.reset();
    if (!isStopped) stoppedSince_.reset();
    if (isStopped && !stoppedSince_) stoppedSince_ = time;
}

void Patience::onNoWay(double time) {
    ++withoutWay_;
    if (!withoutWaySince_) withoutWaySince_ = time;
}

void Patience::onStep(double toGoal, bool isAtGoal, double time) {
    if (toGoal > kAroundGoal) atGoalSince_.reset();
    if (!atGoalSince_ && isAtGoal) atGoalSince_ = time;
}

bool Patience::hasNoWay(double time) const {
    return withoutWay_ >= kMostWithoutWay && time - *withoutWaySince_ >= kLeastWithoutWay;
}

bool Patience::isStopped(double time) const {
    return stoppedSince_ && time - *stoppedSince_ > kLongestStop;
}

bool Patience::isStuckAtGoal(double time) const {
    return atGoalSince_ && time - *atGoalSince_ > kLongestAtGoal;
}

}  // namespace photonav
