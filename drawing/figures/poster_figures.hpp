// SPDX-License-Identifier: BSD-3-Clause
// Figures of a ranking of posters.
#pragma once

#include "figures/problem_view.hpp"
#include "plot/figure.hpp"
#include "posters/poster_study.hpp"

namespace photonav {

/// A set of posters with its name and colour in all figures.
struct DrawnPosterSet {
    const PosterSet* set;
    std::string name;
    Color color;
};

/// At most six sets, the best ones, each in its own colour, and the scene without posters in grey;
/// best set first.
std::vector<DrawnPosterSet> drawnSets(const PosterProblem& problem, const PosterRanking& ranking);

/// The paths of all sets that have one.
std::vector<DrawnPath> pathsOf(const PosterProblem& problem,
                               const std::vector<DrawnPosterSet>& sets);

/// Standard deviation of the position, along its weakest direction, over the path of each set.
Figure posterSigmaFigure(const std::vector<DrawnPosterSet>& sets);

/// The view at the goal with each set of posters.
Figure posterGoalsFigure(const std::vector<DrawnPosterSet>& sets);

/// The scene from above with each set: outlines of the posters, and the path.
Figure posterMapsFigure(const PosterProblem& problem, const std::vector<DrawnPosterSet>& sets);

}  // namespace photonav
