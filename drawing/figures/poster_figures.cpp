// SPDX-License-Identifier: BSD-3-Clause
#include "figures/poster_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "check/check_result.hpp"
#include "figures/images.hpp"

namespace photonav {
namespace {

constexpr Color kAsItIs{98, 104, 112}, kLostPlace{200, 30, 45}, kOutline{200, 30, 45};
constexpr std::size_t kColumnsOfSets = 3;

template <typename Item>
std::vector<std::vector<Item>> inRows(std::vector<Item> items) {
    std::vector<std::vector<Item>> rows;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (i % kColumnsOfSets == 0) rows.emplace_back();
        rows.back().push_back(std::move(items[i]));
    }
    return rows;
}

/// The sides of its triangles but those between two of one plane.
void addOutline(const Scene& surfaces, std::vector<Edge>& outline) {
    const auto normal = [](const Triangle& t) -> Eigen::Vector3f {
        return (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]).normalized();
    };
    for (const Triangle& triangle : surfaces.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto &a = triangle.corners[i], &b = triangle.corners[(i + 1) % 3];
            const bool isWithin = std::ranges::any_of(surfaces.triangles, [&](const Triangle& t) {
                return &t != &triangle && std::ranges::count(t.corners, a) > 0 &&
                       std::ranges::count(t.corners, b) > 0 &&
                       std::abs(normal(t).dot(normal(triangle))) > 0.999F;
            });
            if (!isWithin) outline.push_back({a, b});
        }
    }
}

}  // namespace

std::vector<DrawnPosterSet> drawnSets(const PosterProblem& problem, const PosterRanking& ranking) {
    std::vector<DrawnPosterSet> drawn;
    std::size_t colors = 0;
    for (const PosterSet& set : ranking.sets) {
        const std::string name = nameOf(set.posters, problem.posters);
        if (set.posters.empty()) {
            drawn.push_back({&set, name, kAsItIs});
        } else if (colors < kSeriesColors.size()) {
            drawn.push_back({&set, name, kSeriesColors[colors++]});
        }
    }
    return drawn;
}

std::vector<DrawnPath> pathsOf(const PosterProblem& problem,
                               const std::vector<DrawnPosterSet>& sets) {
    std::vector<DrawnPath> paths;
    for (const DrawnPosterSet& drawn : sets) {
        if (!drawn.set->path) continue;
        paths.push_back(
            drawnPath(pathOf(*drawn.set->path, drawn.name), problem.config.camera.T_b_c()));
        paths.back().color = drawn.color;
    }
    return paths;
}

Figure posterSigmaFigure(const std::vector<DrawnPosterSet>& sets) {
    Plot plot;
    plot.width = 900.;
    plot.height = 420.;
    plot.x = {.min = 0., .label = "distance along the path [m]"};
    plot.y = {.log = true, .label = "position, weakest direction [m]"};
    for (std::size_t i = sets.size(); i-- > 0;) {
        if (!sets[i].set->path) continue;
        Plot::Points curve, lost;
        for (const CheckedPlace& place : sets[i].set->path->places) {
            curve.emplace_back(place.length, place.positionSigma);
            if (place.loss != LossCause::none) lost.push_back(curve.back());
        }
        // Wider below: a curve that is the same as a better one shows on both sides of it.
        plot.curve(curve, {.color = sets[i].color,
                           .width = 2.2 + 0.9 * static_cast<double>(i),
                           .name = sets[i].name});
        if (!lost.empty()) plot.dots(lost, {.color = kLostPlace, .width = 5., .name = "lost"});
    }
    return {"Standard deviation of the position along the path", {{plot}}};
}

Figure posterGoalsFigure(const std::vector<DrawnPosterSet>& sets) {
    std::vector<CaptionedImage> images;
    images.reserve(sets.size());
    for (const DrawnPosterSet& drawn : sets) {
        images.push_back({drawn.name, predictedPicture(*drawn.set->goalView)});
    }
    return imagesFigure(inRows(std::move(images)), 460.);
}

Figure posterMapsFigure(const PosterProblem& problem, const std::vector<DrawnPosterSet>& sets) {
    std::vector<TopView> maps;
    for (const DrawnPosterSet& drawn : sets) {
        const World world = worldWith(problem, drawn.set->posters);
        TopView& map =
            maps.emplace_back(viewFromAbove(problem.config, world, pathsOf(problem, {drawn})));
        map.title = drawn.name;
        map.goal = problem.T_w_goal.translation();
        DrawnTree outline{"poster", kOutline, {}, true};
        for (const std::size_t i : drawn.set->posters) {
            addOutline(problem.posters[i].surfaces, outline.edges);
        }
        map.trees.push_back(std::move(outline));
    }
    return mapsFigure(inRows(std::move(maps)));
}

}  // namespace photonav
