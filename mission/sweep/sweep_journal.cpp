// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/sweep_journal.hpp"

#include <cmath>
#include <stdexcept>

#include "geometry/constants.hpp"
#include "result/json_values.hpp"

namespace photonav {
using nlohmann::json;
namespace {

/// Checks what holds for every path that is charged for its length: cost >= alpha length.
/// @throws std::out_of_range for a run that cannot be
void checkPossible(const SweepRun& run) {
    constexpr double kRounding = 1. - 1e-6;
    if (run.isSolved() != std::isfinite(run.cost)) throw std::out_of_range("cost");
    if (run.isSolved() == run.path.empty()) throw std::out_of_range("path");
    if (!run.isSolved()) return;
    if (!(std::isfinite(run.meanTrace) && std::isfinite(run.goalTrace))) {
        throw std::out_of_range("trace");
    }
    double way = 0.;
    for (std::size_t i = 1; i < run.path.size(); ++i)
        way += (run.path[i].position - run.path[i - 1].position).norm();
    if (!(run.length >= kRounding * way) || run.length > 1.01 * way + 0.01) {
        throw std::out_of_range("length");
    }
    if (!(run.cost >= kRounding * run.item.alpha * run.length)) throw std::out_of_range("cost");
}

}  // namespace

json toJson(const SweepRun& run) {
    return {{"planner", run.item.planner},
            {"alpha", run.item.alpha},
            {"seed", run.item.seed},
            {"cost", finiteOrNull(run.cost)},
            {"length", finiteOrNull(run.length)},
            {"mean_trace", finiteOrNull(run.meanTrace)},
            {"goal_trace", finiteOrNull(run.goalTrace)},
            {"vertices", run.vertices},
            {"views", run.views},
            {"seconds", run.seconds},
            {"status", run.status}};
}

json SweepKind::save(const SweepRun& run, const std::filesystem::path& /*folder*/) {
    json line = toJson(run);
    line["path"] = json::array();
    for (const auto& [p, yaw] : run.path) {
        line["path"].push_back({p.x(), p.y(), p.z(), yaw.value_or(0.)});
    }
    return line;
}

json SweepKind::reproducible(const SweepRun& run) {
    json line = save(run, {});
    line.erase("seconds");
    return line;
}

SweepRun SweepKind::load(const json& line, const std::filesystem::path& /*folder*/) {
    const auto number = [&](const char* key) {
        return line.at(key).is_null() ? kNone : nonNegative(line, key);
    };
    SweepRun run{
        {line.at("planner"), line.at("alpha"), wholeNumber<std::uint32_t>(line.at("seed"))},
        number("cost"),
        number("length"),
        number("mean_trace"),
        number("goal_trace"),
        wholeNumber<std::size_t>(line.at("vertices")),
        wholeNumber<std::size_t>(line.at("views")),
        nonNegative(line, "seconds"),
        line.at("status"),
        {}};
    for (const json& p : line.at("path")) {
        const Eigen::Vector3d place(p.at(0), p.at(1), p.at(2));
        if (!(place.norm() <= kMostOfARun)) throw std::out_of_range("path");
        const double heading = p.at(3);
        if (!(std::abs(heading) <= kLargestHeading)) throw std::out_of_range("heading");
        run.path.push_back({place, heading});
    }
    checkPossible(run);
    return run;
}

}  // namespace photonav
