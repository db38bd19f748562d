// SPDX-License-Identifier: BSD-3-Clause
#include "plans/plan_progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "planners/belief_rrt_star.hpp"

namespace photonav {

std::optional<double> RemainingGrowth::seconds() const {
    if (history_.empty()) return {};
    const PlanProgress& now = history_.back();
    const auto count = static_cast<double>(now.vertices);
    if (count >= vertices_) return {};
    const auto half = std::ranges::find_if(
        history_, [&](const PlanProgress& p) { return 2 * p.vertices >= now.vertices; });
    const bool isSearched =
        half->vertices > BeliefRRTstar::kFirstSearch && std::isfinite(half->cost);
    if (!isSearched || half->vertices >= now.vertices || half->seconds <= 0.) return {};
    const double power = std::log(now.seconds / half->seconds) /
                         std::log(count / static_cast<double>(half->vertices));
    constexpr double kSteepest = 2.;
    return now.seconds * (std::pow(vertices_ / count, std::clamp(power, 1., kSteepest)) - 1.);
}

std::string progressText(const PlanProgress& progress, unsigned vertices,
                         const RemainingGrowth& growth) {
    const std::string cost = std::isfinite(progress.cost)
                                 ? fmt::format("best cost {:.3f}", progress.cost)
                                 : "no path yet";
    const auto rest = growth.seconds();
    const std::string soFar = fmt::format("{:.0f} s so far", progress.seconds);
    const std::string time = progress.vertices >= vertices ? "improving the path, " + soFar
                             : rest
                                 ? fmt::format("about {} to the last vertex", durationText(*rest))
                                 : soFar;
    return fmt::format("{} of {} vertices, {}, {} views, {}", progress.vertices, vertices, cost,
                       progress.views, time);
}

OnPlanProgress shownOn(ProgressLine& line, unsigned vertices, const std::string& purpose) {
    return [&line, vertices, purpose,
            growth = RemainingGrowth(vertices)](const PlanProgress& progress) mutable {
        growth.add(progress);
        line.show(fmt::format("{}: {}", purpose, progressText(progress, vertices, growth)));
    };
}

OnPlanProgress kappaShownOn(ProgressLine& line, const Config& config) {
    return shownOn(line, config.vertices, "kappa by rrt_star");
}

void sayKappa(ProgressLine& line, const Config& given, double kappa) {
    if (!isAutomatic(given.belief.kappa)) return;
    line.say(fmt::format("planner.kappa: auto is {:.4g} 1/m²", kappa));
}

Config withKappaSaid(const Config& given, const World& world, ProgressLine& line,
                     const std::atomic<bool>& interrupted) {
    Config config = withKappa(given, world, interrupted, kappaShownOn(line, given));
    if (!interrupted) sayKappa(line, given, config.belief.kappa);
    return config;
}

}  // namespace photonav
