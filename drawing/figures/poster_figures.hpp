// SPDX-License-Identifier: BSD-3-Clause
// Figures of a ranking of posters.
#pragma once

#include "figures/problem_view.hpp"
#include "plot/figure.hpp"
#include "posters/poster_study.hpp"

namespace photonav {

/// A set as figures draw it.
struct DrawnPosterSet {
    const PosterSet* set;
    std::string name;
    Color color;
};

/// The best sets, each in a colour of its own, and the scene as it is, in grey; the best first.
std::vector<DrawnPosterSet> drawnSets(const PosterProblem& problem, const PosterRanking& ranking);

/// The paths of sets that have one.
std::vector<DrawnPath> pathsOf(const PosterProblem& problem,
                               const std::vector<DrawnPosterSet>& sets);

/// Standard deviation of the position along the path of each set.
Figure posterSigmaFigure(const std::vector<DrawnPosterSet>& sets);

/// The image at the goal with each set.
Figure posterGoalsFigure(const std::vector<DrawnPosterSet>& sets);

/// The scene with each set from above: its posters outlined, and its path.
Figure posterMapsFigure(const PosterProblem& problem, const std::vector<DrawnPosterSet>& sets);

}  // namespace photonav
