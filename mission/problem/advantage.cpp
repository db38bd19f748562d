// SPDX-License-Identifier: BSD-3-Clause
#include "problem/advantage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace photonav {
namespace {

constexpr double kLittle = 0.05;  // share of the cost that cannot pay for a detour worth a mention

bool isInformed(const EvaluatedPath& path) {
    return std::any_of(path.points.begin(), path.points.end(),
                       [](const BeliefPoint& point) { return point.information.trace() > 0.; });
}

/// The part of the cost that is charged for uncertainty.
double uncertaintyOf(const EvaluatedPath& path) { return (1. - path.lengthShare) * path.cost; }

bool isAlike(double a, double b) { return std::abs(a - b) <= kLeastAdvantage * std::abs(b); }

std::string reasonOf(const EvaluatedPath& path, const EvaluatedPath& shortest, double alpha) {
    if (alpha >= 1.) return "alpha is 1, only the length counts";
    const double uncertainty = 1. - shortest.lengthShare;
    if (uncertainty < kLittle) {
        return fmt::format(
            "uncertainty is only {:.2g} % of the cost of the shortest path; with a larger kappa, "
            "or kappa: auto, it counts more",
            100. * std::max(0., uncertainty));
    }
    if (!isInformed(path) && !isInformed(shortest)) {
        return "no view along either path has information";
    }
    if (path.cost < (1. - kLeastAdvantage) * shortest.cost) {
        return "the path that was found is cheaper, but not because it is more certain: with more "
               "vertices RRT* may find it, too";
    }
    if (isAlike(path.length, shortest.length) && isAlike(path.meanTrace, shortest.meanTrace)) {
        return "the shortest path is also as certain as the one that was found";
    }
    if (path.cost > (1. + kLeastAdvantage) * shortest.cost) {
        return "the search has not found a better path than the shortest one; more vertices may";
    }
    return "what the path gains in certainty it costs in length; with a smaller alpha certainty "
           "counts more";
}

}  // namespace

std::string noAdvantage(const EvaluatedPath& path, const EvaluatedPath& shortest, double alpha) {
    const double gain = shortest.cost - path.cost;
    const double ofCertainty = uncertaintyOf(shortest) - uncertaintyOf(path);
    if (std::min(gain, ofCertainty) > kLeastAdvantage * shortest.cost) return "";
    return "no advantage over the shortest path: " + reasonOf(path, shortest, alpha);
}

std::string costShares(const EvaluatedPath& path) {
    const double length = 100. * path.lengthShare;
    const int decimals = std::min(length, 100. - length) < 1. ? 2 : 0;
    return fmt::format("{:.{}f} % length, {:.{}f} % uncertainty", length, decimals, 100. - length,
                       decimals);
}

}  // namespace photonav
