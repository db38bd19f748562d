// SPDX-License-Identifier: BSD-3-Clause
#include "flights/servo_command.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "alignment/image_pyramid.hpp"
#include "flights/servo_report.hpp"
#include "io/error.hpp"
#include "io/number.hpp"
#include "io/stopwatch.hpp"
#include "render/interruptible_views.hpp"
#include "result/json_values.hpp"
#include "shared/place_option.hpp"
#include "shared/result_folder.hpp"

namespace photonav {
namespace {

/// Numbers from 0 on, at least one of them.
std::vector<double> listOf(const char* option, const std::string& text, double most) {
    const auto numbers = numbersIn(text, ',');
    const bool isGood =
        numbers && std::ranges::all_of(*numbers, [most](double x) { return x >= 0. && x <= most; });
    if (!isGood) {
        throw InputError(option, text, fmt::format("expected numbers from 0 to {:g}: a,b,c", most));
    }
    return *numbers;
}

void printBasin(const ServoStudy& study) {
    if (study.converged() == 0) {
        fmt::print("none of {} starts converges\n", study.trials());
        return;
    }
    for (const BasinCell& cell : study.basin) {
        fmt::print("from {:5g} m, {:3g} deg: {:3} of {} converge ({:.0f} to {:.0f} %)\n",
                   cell.distance, cell.angle, cell.converged, cell.trials, 100. * cell.low,
                   100. * cell.high);
    }
}

}  // namespace

ServoStudyOptions studyOf(const ServoOptions& options, const Config& config) {
    ServoStudyOptions study = options.study;
    if (options.distances) study.distances = listOf("--distances", *options.distances, 1e3);
    if (options.angles) study.angles = listOf("--angles", *options.angles, 180.);
    study.seed = config.seed;
    if (study.gain > study.rate) {
        throw InputError("--gain", "", "above --rate: a step would go beyond the goal");
    }
    return study;
}

int runServo(const ServoOptions& options, const std::atomic<bool>& interrupted) {
    const Stopwatch watch;
    const Config config = loadConfig(options.config, options.overrides);
    const ServoStudyOptions study = studyOf(options, config);
    const Place place = placeOf(options.at, config.goal, config);
    const World world(config);
    FolderTransaction folder = beginResult(options, "servo", inputsOf(config));
    // At half the size: a quarter of the work, and it converges from twice as far.
    const InterruptibleViews views(world.sharedViews(), [&] { return interrupted.load(); });
    const ServoGoal goal{views, halved(config.camera.camera()), config.camera.T_b_c(),
                         bodyAt(place), config.photometric};
    ProgressLine line(options.quiet);
    const ServoStudy result = studyServo(goal, study, interrupted, [&](double share) {
        line.show(fmt::format("{:.0f} % of the starts", 100. * share), share);
    });
    line.clear();
    const ServoReport report{config, world, goal, study, result};
    nlohmann::json content = servoResult(goal, study, result);
    content["time"]["total_s"] = watch.seconds();
    writeServoReport(folder.path(), report, options.commandLine, content);
    concludeResult(folder, options, content, [&] {
        printTable(servoSummary(report));
        printBasin(result);
    });
    if (result.interrupted) return kInterrupted;
    return result.modes.front().rate > 0. ? kDone : kNoAnswer;
}

}  // namespace photonav
