// SPDX-License-Identifier: BSD-3-Clause
#include "flights/posters_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "check/check_result.hpp"
#include "dataset/image_file.hpp"
#include "figures/poster_figures.hpp"
#include "report/problem_report.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kPathWidth = 34, kGoalWidth = 28, kWidth = 80;  // of columns

/// A text in lines of whole words.
std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
    std::vector<std::string> lines;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (lines.empty() || lines.back().size() + 1 + word.size() > width) {
            lines.push_back(word);
        } else {
            lines.back() += " " + word;
        }
    }
    return lines;
}

/// At most six characters.
std::string numberOr(const char* otherwise, double value, double scale = 1.) {
    if (!std::isfinite(value)) return otherwise;
    const std::string text = fmt::format("{:.3g}", scale * value);
    return text.size() <= 6 ? text : fmt::format("{:.0e}", scale * value);
}

/// At most seven characters.
std::string traceText(double trace) {
    return trace < 1e-3 || trace >= 1e4 ? fmt::format("{:.1e}", trace)
                                        : fmt::format("{:.3g}", trace);
}

std::string pathColumns(const PosterSet& set) {
    if (!set.path) return fmt::format("{:>{}}", "no path", kPathWidth);
    const CheckedTrajectory& path = *set.path;
    const std::string cost = set.cost > 0. ? fmt::format("{:.4g}", set.cost) : "-";
    return fmt::format("{:6.2f}{:>7}{:>8}{:>8}{:5.1f}", path.length, cost,
                       traceText(path.meanTrace), traceText(path.places.back().trace),
                       path.lostLength());
}

std::string goalColumns(const ServoStudy& servo) {
    const ServoMode& slowest = servo.modes.front();
    return fmt::format("{:>7}{:>6}{:>9}{:>6}", numberOr("open", servo.positionSigma, 1e3),
                       slowest.rate > 0. ? fmt::format("{:.3g}", 1. / slowest.rate) : "never",
                       numberOr("-", servo.condition),
                       fmt::format("{}/{}", servo.converged(), servo.trials()));
}

std::string goalText(const ServoStudy& servo) {
    const ServoMode& slowest = servo.modes.front();
    const std::string direction = inWords(slowest, servo.depth);
    const std::string start =
        servo.openDirections() == 1 ? direction + " is open"
        : servo.openDirections() > 1
            ? fmt::format("{} of {} directions are open", servo.openDirections(),
                          servo.modes.size())
            : fmt::format("position {}, slowest {} in {:.3g} s, condition {:.3g}",
                          lengthText(servo.positionSigma), direction, 1. / slowest.rate,
                          servo.condition);
    return fmt::format("{}; {} of {} starts converged", start, servo.converged(), servo.trials());
}

std::string pathText(const PosterSet& set) {
    if (!set.path) return "no path found";
    const CheckedTrajectory& path = *set.path;
    const CheckedPlace& worst = path.worst();
    std::string text = fmt::format(
        "{:.2f} m, mean trace {:.3g} m², at the goal {:.3g} m²; least certain after {:.2f} m: {}",
        path.length, path.meanTrace, path.places.back().trace, worst.length,
        lengthText(worst.positionSigma));
    if (set.cost > 0.) text = fmt::format("cost {:.4g}, {}", set.cost, text);
    return path.isLost() ? fmt::format("{}; {}", text, verdictOf(path)) : text;
}

std::vector<ReportTable> tablesOf(const PosterProblem& problem, const PosterRanking& ranking) {
    ReportTable paths{"Paths, the sets in their order", {}};
    ReportTable goals{"Servoing at the goal, the sets in their order", {}};
    std::size_t rank = 0;
    for (const PosterSet& set : ranking.sets) {
        const std::string name =
            fmt::format("{}. {}", ++rank, nameOf(set.posters, problem.posters));
        paths.rows.emplace_back(name, pathText(set));
        goals.rows.emplace_back(name, goalText(set.servo));
    }
    if (!problem.options.hasPath) return {goals};
    return {paths, goals};
}

}  // namespace

std::string rankingText(const PosterProblem& problem, const PosterRanking& ranking) {
    const bool hasPath = problem.options.hasPath;
    const std::size_t nameWidth = kWidth - kGoalWidth - 2 - (hasPath ? kPathWidth : 0);
    std::string text;
    const auto add = [&](const std::string& path, const std::string& goal,
                         const std::string& name) {
        text += fmt::format("{:{}}{:{}}  {}", hasPath ? path : "", hasPath ? kPathWidth : 0, goal,
                            kGoalWidth, name);
        text.erase(text.find_last_not_of(' ') + 1);
        text += "\n";
    };
    add("  path (traces in m²)", "  servoing at the goal", "");
    add("length   cost    mean    goal lost", "  sigma  slow   condi- conv-", "with");
    add("   [m]          trace   trace  [m]", "   [mm]   [s]     tion erged", "");
    for (const PosterSet& set : ranking.sets) {
        const auto lines = wrapped(nameOf(set.posters, problem.posters), nameWidth);
        add(pathColumns(set), goalColumns(set.servo), lines.front());
        for (std::size_t i = 1; i < lines.size(); ++i) add("", "", lines[i]);
    }
    return text;
}

void writePostersReport(const fs::path& folder, const PosterProblem& problem,
                        const PosterRanking& ranking, const std::string& commandLine,
                        const json& result) {
    const std::vector<DrawnPosterSet> sets = drawnSets(problem, ranking);
    const PosterSet& best = ranking.sets.front();
    const World world = worldWith(problem, best.posters);
    json shown = result;
    for (json& set : shown["ranking"]) {
        if (!set["path"].is_null()) set["path"].erase("path");
    }
    ReportData page = problemReport(problem.config, world, commandLine, shown);
    page.title = fs::path(problem.config.file).stem().string();
    page.subtitle = "Posters and carpets ranked; shown is the scene with the best.";
    page.goal = problem.T_w_goal.translation();
    page.paths = pathsOf(problem, sets);
    page.tables = tablesOf(problem, ranking);
    std::vector<NamedFigure> figures{
        {"maps", "From above: each set of posters (outlined) and its path, the best first.",
         posterMapsFigure(problem, sets)},
        {"goals", "The image at the goal.", posterGoalsFigure(sets)}};
    if (!page.paths.empty()) {
        figures.insert(figures.begin(),
                       {"sigma", "Standard deviation of the position along its weakest direction.",
                        posterSigmaFigure(sets)});
    }
    writeResultFolder(folder, page, figures);
}

}  // namespace photonav
