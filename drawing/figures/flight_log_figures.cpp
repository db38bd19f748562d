// SPDX-License-Identifier: BSD-3-Clause
#include "figures/flight_log_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace photonav {
namespace {

constexpr double kStageSide = 360., kPlansSide = 820., kFilmSide = 400.;  // of a map [px]
constexpr std::size_t kMostPlans = 12;
constexpr Color kFlown{75, 85, 99};

/// Moments with pictures, at about equal distances flown.
std::vector<std::size_t> stagesOf(const FlightLog& log, std::size_t count) {
    const double way = log.moments.back().length;
    std::vector<std::size_t> stages;
    for (std::size_t i = 0; i < count; ++i) {
        const double wanted = count > 1 ? way * static_cast<double>(i) / (count - 1.) : way;
        std::size_t best = 0;
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < log.moments.size(); ++k) {
            if (log.moments[k].pictures.empty()) continue;
            // Of moments at the same place the last one: the robot has waited.
            const double away = std::abs(log.moments[k].length - wanted);
            if (away <= nearest) best = k;
            nearest = std::min(nearest, away);
        }
        if (stages.empty() || stages.back() != best) stages.push_back(best);
    }
    return stages;
}

Plot::Points placesOf(const std::vector<PathPoint>& plan) {
    Plot::Points places;
    for (const PathPoint& point : plan) places.emplace_back(point.position.head<2>());
    return places;
}

/// Plan, path flown and robot over a map.
void addFlight(Plot& plot, const FlightLog& log, const LoggedMoment& moment) {
    plot.curve(flownUntil(log, moment.update.time),
               {.color = kFlown, .width = 2.4, .name = "path flown", .halo = 1.2});
    plot.curve(placesOf(moment.plan), {.color = plannerColor(log.planner),
                                       .width = 3.2,
                                       .name = "plan, " + log.planner,
                                       .halo = 1.2});
    plot.marker(moment.robot.position.head<2>(), kInk, "robot");
}

Plot scenePanel(const FlightLog& log, const LoggedMoment& moment, TopView scene, double side) {
    scene.trees = {{"tree", kTreeColor, moment.pictures.tree}};
    scene.paths = {{"plan, " + log.planner, plannerColor(log.planner), moment.plan}};
    Plot plot = topViewPlot(scene, side);
    plot.title = fmt::format("{:.1f} s, {:.1f} m flown", moment.update.time, moment.length);
    plot.curve(flownUntil(log, moment.update.time),
               {.color = kFlown, .width = 2.4, .name = "path flown", .halo = 1.2});
    const Eigen::Matrix2d covariance = moment.robot.positionCovariance.topLeftCorner<2, 2>();
    plot.fill({ellipse(moment.robot.position.head<2>(), covariance, 3.)},
              {.color = kInk, .opacity = 0.5, .name = "3σ of the robot"});
    plot.marker(moment.robot.position.head<2>(), kInk, "robot");
    return plot;
}

Plot gridPanel(const FlightLog& log, const Picture& grid, double side) {
    Plot plot = Plot::map(log.area, side);
    if (grid.columns > 0) plot.picture(grid, log.area, false);
    return plot;
}

LevelRange rangeOf(const FlightLog& log) {
    LevelRange range;
    for (const LoggedMoment& moment : log.moments) {
        if (!moment.pictures.information.empty()) range.add(moment.pictures.information);
    }
    return range;
}

Picture pictureOf(const FlightLog& log, std::size_t moment, std::string MomentPictures::*part,
                  const std::function<Picture(const std::string&)>& draw) {
    const std::string* file = latest(log, moment, part);
    return file == nullptr ? Picture{} : draw(*file);
}

Axis informationScale(const LevelRange& range) {
    return {.min = LevelRange::traceOf(range.least),
            .max = LevelRange::traceOf(std::max(range.largest, range.least + 1)),
            .log = true,
            .label = "trace of the information"};
}

}  // namespace

Plot::Points flownUntil(const FlightLog& log, double time) {
    Plot::Points places;
    const auto add = [&](const std::vector<FlownPoint>& flown) {
        for (const FlownPoint& point : flown) {
            if (point.time <= time + 1e-6)
                places.emplace_back(point.truth.head<2>().cast<double>());
        }
    };
    for (const LoggedMoment& moment : log.moments) add(moment.flown);
    add(log.rest);
    return places;
}

Figure stagesFigure(const FlightLog& log, const TopView& scene, std::size_t columns) {
    Figure figure{"The exploration in stages, " + log.planner};
    figure.rows.resize(3);
    const LevelRange range = rangeOf(log);
    const std::vector<std::size_t> stages = stagesOf(log, columns);
    for (const std::size_t k : stages) {
        const LoggedMoment& moment = log.moments[k];
        figure.rows[0].push_back(scenePanel(log, moment, scene, kStageSide));
        figure.rows[1].push_back(gridPanel(
            log, pictureOf(log, k, &MomentPictures::obstacles, obstaclePicture), kStageSide));
        figure.rows[2].push_back(
            gridPanel(log,
                      pictureOf(log, k, &MomentPictures::information,
                                [&](const std::string& f) { return informationPicture(f, range); }),
                      kStageSide));
        for (std::size_t row = 1; row < 3; ++row) addFlight(figure.rows[row].back(), log, moment);
        if (k == stages.back() && !range.empty()) {
            figure.rows[2].back().colorBar(informationScale(range));
        }
    }
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < stages.size(); ++column) {
            Plot& plot = figure.rows[row][column];
            if (row < 2) plot.x.label.clear();
            if (column > 0) plot.y.label.clear();
        }
    }
    return figure;
}

Figure plansFigure(const FlightLog& log, const TopView& scene) {
    TopView empty = scene;
    empty.trees.clear();
    empty.paths.clear();
    Plot plot = topViewPlot(empty, kPlansSide);
    const std::size_t step = (log.moments.size() + kMostPlans - 1) / kMostPlans;
    const double last = std::max(log.moments.back().update.time, 1e-3);
    for (std::size_t k = 0; k < log.moments.size(); k += step) {
        const LoggedMoment& moment = log.moments[k];
        plot.curve(placesOf(moment.plan),
                   {.color = viridis(moment.update.time / last), .width = 2.6, .halo = 0.8});
    }
    plot.curve(flownUntil(log, std::numeric_limits<double>::infinity()),
               {.color = kInk, .width = 1.6, .name = "path flown", .dashed = true});
    plot.colorBar({.min = 0., .max = last, .label = "time of the plan [s]"});
    return {"Plans over time, " + log.planner, {{plot}}};
}

FilmScript::FilmScript(const FlightLog& log, const TopView& scene)
    : log_(log), scene_(scene), range_(rangeOf(log)) {
    const auto add = [&](const std::vector<FlownPoint>& flown) {
        for (const FlownPoint& point : flown) {
            if (point.trace > 0.F) traces_.emplace_back(point.time, point.trace);
        }
    };
    for (const LoggedMoment& moment : log.moments) add(moment.flown);
    add(log.rest);
}

Plot FilmScript::tracePanel(double time) const {
    Plot plot;
    plot.title = "Uncertainty of the pose";
    plot.width = kFilmSide;
    plot.height = kFilmSide * 0.64;
    double least = std::numeric_limits<double>::infinity(), largest = 0.;
    for (const Plot::Point& point : traces_) {
        least = std::min(least, point.y());
        largest = std::max(largest, point.y());
    }
    if (largest > least) plot.y = {.min = 0.8 * least, .max = 1.25 * largest};
    plot.y.log = true;
    plot.y.label = "trace [m²]";
    plot.x = {.min = 0., .max = traces_.empty() ? 1. : traces_.back().x(), .label = "time [s]"};
    Plot::Points until;
    for (const Plot::Point& point : traces_) {
        if (point.x() <= time + 1e-6) until.push_back(point);
    }
    plot.curve(until, {.color = plannerColor(log_.planner), .width = 2.6});
    return plot;
}

Figure FilmScript::frame(double time, std::size_t moment) const {
    const LoggedMoment& at = log_.moments[moment];
    LoggedMoment now = at;  // with the robot where it is by now
    now.update.time = time;
    const Plot::Points flown = flownUntil(log_, time);
    if (!flown.empty()) now.robot.position.head<2>() = flown.back();
    const auto image = [&](const char* title, std::string MomentPictures::*part) {
        const std::string* file = latest(log_, moment, part);
        Picture picture = file == nullptr ? Picture{} : greyPicture(*file);
        if (picture.rows() == 0) picture = {{kWhite}, 1};
        Plot plot = Plot::image(std::move(picture), kFilmSide, true);
        plot.title = title;
        return plot;
    };
    const auto grid = [&](const char* title, const Picture& picture) {
        Plot plot = gridPanel(log_, picture, kFilmSide);
        addFlight(plot, log_, now);
        plot.title = title;
        plot.y.label.clear();
        return plot;
    };
    Figure figure{.legend = Figure::Legend::none};
    figure.title = fmt::format("{}, {:5.1f} s, {:4.1f} m flown", log_.planner, time, now.length);
    Plot scene = scenePanel(log_, now, scene_, kFilmSide);
    scene.title = "True scene, tree and plan";
    figure.rows = {
        {scene,
         grid("Map: free (white), obstacles (black)",
              pictureOf(log_, moment, &MomentPictures::obstacles, obstaclePicture)),
         grid("Information of a view (bright: much)",
              pictureOf(log_, moment, &MomentPictures::information,
                        [&](const std::string& f) { return informationPicture(f, range_); }))},
        {image("Camera", &MomentPictures::observed),
         image("Predicted from the map", &MomentPictures::predicted), tracePanel(time)}};
    return figure;
}

}  // namespace photonav
