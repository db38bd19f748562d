// SPDX-License-Identifier: BSD-3-Clause
#include "plans/info_command.hpp"

#include <fmt/format.h>

#include "dataset/image_file.hpp"
#include "figures/heat_map.hpp"
#include "figures/images.hpp"
#include "geometry/eigensystem.hpp"
#include "io/error.hpp"
#include "io/stopwatch.hpp"
#include "report/problem_report.hpp"
#include "result/json_values.hpp"
#include "shared/place_option.hpp"
#include "shared/result_folder.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

struct Direction {
    const char* name;
    const char* what;
};
constexpr std::array<Direction, 6> kDirections{
    {{"right", "motion to the right"},
     {"down", "motion down in the image"},
     {"forward", "motion along the optical axis"},
     {"about_right", "rotation about the image's x axis"},
     {"about_down", "rotation about the image's y axis"},
     {"about_forward", "rotation about the optical axis"}}};

/// The information of a view from each place at one height, and the uncertainty after it.
struct Grids {
    Eigen::AlignedBox2d area;
    double height;
    Eigen::ArrayXXd information;  ///< trace
    Eigen::ArrayXXd sigma;        ///< of the position [m]
};

json resultOf(const Place& place, const Matrix6& Lambda, const Grids& grids) {
    const Eigen::ArrayXXd& information = grids.information;
    const Eigen::AlignedBox2d& area = grids.area;
    json rows = json::array();
    for (int j = 0; j < information.cols(); ++j) {
        json row = json::array();
        for (int i = 0; i < information.rows(); ++i) row.push_back(finiteOrNull(information(i, j)));
        rows.push_back(row);
    }
    return resultJson("info",
                      {{"view",
                        {{"position", vectorJson(place.position)},
                         {"yaw", place.yaw.value_or(0.)},
                         {"information_frame", "camera, order (rho, phi), upper triangle by rows"},
                         {"information", triangleJson(Lambda)},
                         {"information_trace", Lambda.trace()},
                         {"min_eigenvalue", std::max(0., eigensystem(Lambda).values[0])}}},
                       {"grid",
                        {{"quantity", "trace of the Fisher information of one view"},
                         {"height", grids.height},
                         {"min", {area.min().x(), area.min().y()}},
                         {"max", {area.max().x(), area.max().y()}},
                         {"rows_from_smallest_y", rows}}}});
}

/// The predicted view and its contribution images, all directions together and one by one.
std::vector<NamedFigure> viewFigures(const View& view, const Config& config) {
    const Camera camera = config.camera.camera();
    const auto contribution = [&](const std::string& title, const auto&... direction) {
        return contributionFigure(
            title, view.intensity,
            contributionImage(view, camera, direction..., config.photometric));
    };
    std::vector<NamedFigure> figures{
        {"view", fmt::format("The predicted view, of {} x {} pixels.", camera.width, camera.height),
         greyFigure("The predicted view", view.intensity)},
        {"contribution",
         "The contribution of every pixel to the information, all directions together: its root, "
         "as a share of the pixel that only 0.5 % of the pixels exceed. Over the darkened view.",
         contribution("Contribution to the information")}};
    for (int i = 0; i < 6; ++i) {
        const std::string about = kDirections[i].what;
        figures.push_back(
            {fmt::format("contribution_{}", kDirections[i].name),
             fmt::format("The pixels that inform about {}, on the same kind of scale.", about),
             contribution("Contribution: " + about, Vector6(Vector6::Unit(i)))});
    }
    return figures;
}

std::vector<NamedFigure> heatMaps(const Grids& grids, const std::string& place) {
    const auto heatMap = [&](const char* title, const char* label, const Eigen::ArrayXXd& values) {
        return heatMapFigure(
            {fmt::format("{} at {}", title, place), label, grids.area, values, true});
    };
    return {{"information", "Trace of the Fisher information of one view.",
             heatMap("Information of one view", "trace of the Fisher information [1/m², 1/rad²]",
                     grids.information)},
            {"uncertainty", "Standard deviation of the position after one view.",
             heatMap("Uncertainty after one view", "standard deviation of the position [m]",
                     grids.sigma)}};
}

double heightOf(const InfoOptions& options, const Config& config) {
    const double height = options.height.value_or(config.start.position.z());
    if (!(height >= config.bounds.min().z() && height <= config.bounds.max().z())) {
        throw InputError("--height", fmt::format("{}", height), "outside the bounds of the config");
    }
    return height;
}

Grids lookAround(const InfoOptions& options, const Config& config, double height, double yaw,
                 PlanningProblem& problem) {
    ProgressLine line(options.quiet);
    const auto show = [&](double share) {
        line.show(fmt::format("looking around: {:.0f} %", 100. * share), share);
    };
    const Eigen::AlignedBox2d area(config.bounds.min().head<2>(), config.bounds.max().head<2>());
    const Matrix6& prior = problem.initialCovariance();
    const int cells = options.cells.value_or(100);
    return {area, height,
            viewGrid(
                problem, area, height, yaw, cells, [](const Matrix6& gain) { return gain.trace(); },
                show),
            viewGrid(problem, area, height, yaw, cells, [&](const Matrix6& gain) {
                return std::sqrt(updateCovariance(prior, gain).topLeftCorner<3, 3>().trace());
            })};
}

ReportData reportOf(const InfoOptions& options, const Config& config, const World& world,
                    const Place& place, const json& result) {
    ReportData report = problemReport(config, world, options.commandLine, result);
    report.title = fs::path(config.file).stem().string();
    report.subtitle = "The information that the camera gets from a view.";
    report.result.erase("grid");
    report.start = place.position;
    return report;
}

}  // namespace

int runInfo(const InfoOptions& options, const std::atomic<bool>& interrupted) {
    const Stopwatch watch;
    const Config config = loadConfig(options.config, options.overrides);
    const double height = heightOf(options, config);
    const Place place = placeOf(options.at, config.start, config);
    const World world(config);
    PlanningProblem problem(config, world);
    checkResultFolder(options, "info", interrupted, inputsOf(config));

    const Grids grids = lookAround(options, config, height, place.yaw.value_or(0.), problem);
    const Camera camera = config.camera.camera();
    View view;
    world.views().render(camera, (bodyAt(place) * config.camera.T_b_c()).inverse(), view);
    const Matrix6 Lambda = photometricInformation(view, camera, config.photometric);

    json result = resultOf(place, Lambda, grids);
    auto figures = heatMaps(grids, placeText(config, height, place.yaw.value_or(0.)));
    for (NamedFigure& figure : viewFigures(view, config)) figures.push_back(std::move(figure));
    ReportData report = reportOf(options, config, world, place, result);
    FolderTransaction folder = beginResult(options, "info", inputsOf(config));
    writeResultFolder(folder.path(), report, figures);
    result["time"]["total_s"] = watch.seconds();
    concludeResult(folder, options, result, [&] {
        fmt::print("information trace {:.4g}, smallest eigenvalue {:.4g}\n", Lambda.trace(),
                   result["view"]["min_eigenvalue"].get<double>());
    });
    return kDone;
}

}  // namespace photonav
