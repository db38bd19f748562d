// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/real_time_json.hpp"

#include <fmt/format.h>

#include "result/json_values.hpp"

namespace photonav {
using nlohmann::json;
namespace {

json durationsJson(const Durations& d) {
    return {{"count", d.count},
            {"median_s", d.median},
            {"95_percent_s", d.quantile95},
            {"worst_s", d.worst}};
}

Durations durationsFrom(const json& values) {
    return {wholeNumber<std::size_t>(values.at("count")), nonNegative(values, "median_s"),
            nonNegative(values, "95_percent_s"), nonNegative(values, "worst_s")};
}

std::string inMilliseconds(const Durations& d) {
    if (d.count == 0) return "none";
    return fmt::format("median {:.1f} ms, 95 %: {:.1f} ms, worst {:.1f} ms", 1e3 * d.median,
                       1e3 * d.quantile95, 1e3 * d.worst);
}

}  // namespace

json realTimeJson(const RealTimeSummary& s) {
    return {{"lateness", durationsJson(s.lateness)},
            {"late_steps", s.lateSteps},
            {"exposure_to_answer", durationsJson(s.exposureToAnswer)},
            {"arrival_to_answer", durationsJson(s.arrivalToAnswer)},
            {"plan_age", durationsJson(s.planAge)},
            {"updates_waited", s.waited},
            {"updates_joined", s.joined},
            {"plans_ended_by_clock", s.endedByClock}};
}

RealTimeSummary realTimeFrom(const json& values) {
    const auto count = [&](const char* key) { return wholeNumber<std::size_t>(values.at(key)); };
    return {.lateness = durationsFrom(values.at("lateness")),
            .lateSteps = count("late_steps"),
            .exposureToAnswer = durationsFrom(values.at("exposure_to_answer")),
            .arrivalToAnswer = durationsFrom(values.at("arrival_to_answer")),
            .planAge = durationsFrom(values.at("plan_age")),
            .waited = count("updates_waited"),
            .joined = count("updates_joined"),
            .endedByClock = count("plans_ended_by_clock")};
}

std::vector<std::pair<std::string, std::string>> realTimeRows(const RealTimeSummary& s) {
    return {{fmt::format("control steps late by more than {:.0f} ms", 1e3 * RealTimeMonitor::kLate),
             fmt::format("{} of {}", s.lateSteps, s.lateness.count)},
            {"lateness of the steps", inMilliseconds(s.lateness)},
            {"from exposure to 'is the way free'", inMilliseconds(s.exposureToAnswer)},
            {"from arrival to 'is the way free'", inMilliseconds(s.arrivalToAnswer)},
            {"age of plans when they took effect", inMilliseconds(s.planAge)},
            {"updates that waited; joined to others", fmt::format("{}; {}", s.waited, s.joined)},
            {"plans ended by the clock", fmt::format("{} of {}", s.endedByClock, s.planAge.count)}};
}

}  // namespace photonav
