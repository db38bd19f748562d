// SPDX-License-Identifier: BSD-3-Clause
#include "commands/calibrate_depth_command.hpp"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "commands/command_line.hpp"
#include "commands/result_folder.hpp"
#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "io/atomic_file.hpp"
#include "replay/depth_registration.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace {

using nlohmann::json;

json resultOf(const CalibrateDepthOptions& options, const DepthRegistration& found) {
    const DepthCalibration& c = found.calibration;
    const Eigen::Quaterniond q(c.T_c_d.linear());
    const Eigen::Vector3d p = c.T_c_d.translation();
    const Vector6 sigma = c.covariance.diagonal().cwiseSqrt();
    const std::vector<double> sigmas(sigma.data(), sigma.data() + 6);
    return {{"schema", 1},
            {"command", "calibrate-depth"},
            {"version", PHOTONAV_VERSION},
            {"dataset", options.dataset},
            {"pairs", found.pairs},
            {"T_colour_depth", {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}},
            {"sigma", sigmas},
            {"sigma_is_of", "left perturbation (rho, phi), colour camera's frame [m, rad]"},
            {"median_residual_before", c.residualBefore},
            {"median_residual_after", c.residualAfter}};
}

ReportTable summaryOf(const DepthRegistration& found) {
    const DepthCalibration& c = found.calibration;
    const Vector6 xi = logSE3(c.T_c_d);
    const Vector6 sigma = c.covariance.diagonal().cwiseSqrt();
    ReportTable table{"Depth camera, from its frame to the colour camera's", {}};
    constexpr std::array kNames = {"x", "y", "z", "about x", "about y", "about z"};
    for (int i = 0; i < 6; ++i) {
        const bool isTurn = i >= 3;
        const double unit = isTurn ? kDegree : 1e-3;
        table.rows.emplace_back(kNames.at(std::size_t(i)),
                                fmt::format("{:.2f} +- {:.2f} {}", xi[i] / unit, sigma[i] / unit,
                                            isTurn ? "deg" : "mm"));
    }
    table.rows.emplace_back("pairs of images", std::to_string(found.pairs));
    table.rows.emplace_back("median residual", fmt::format("{:.5f} (before {:.5f})",
                                                           c.residualAfter, c.residualBefore));
    return table;
}

}  // namespace

int runCalibrateDepth(const CalibrateDepthOptions& options, const std::atomic<bool>& interrupted) {
    ProgressLine line(options.quiet);
    const DepthRegistration found = registerDepth(
        options, [&] { return interrupted.load(); },
        [&](std::size_t done, std::size_t all) {
            line.show(fmt::format("{} of {} images", done, all));
        });
    line.clear();
    if (found.isInterrupted) return kInterrupted;
    FolderTransaction folder = beginResult(options.out, {options.dataset, options.cameraFile});
    const json result = resultOf(options, found);
    writeFileAtomically(folder.path() / "camera.yaml", cameraYaml(found.sequence));
    commitResult(folder, result);
    std::filesystem::path out = options.out;
    bool quiet = options.quiet, asJson = options.json;
    printOutput({out, quiet, asJson}, result, summaryOf(found), {"camera.yaml", "result.json"});
    return kDone;
}

Command calibrateDepthCommand(CLI::App& app, const Invocation& invocation) {
    auto options = std::make_shared<CalibrateDepthOptions>();
    CLI::App* parser = app.add_subcommand(
        "calibrate-depth",
        "Find where the depth camera of a recording sits beside its colour camera.");
    parser->add_option("dataset", options->dataset, "folder in the TUM RGB-D layout")->required();
    parser->add_option("--camera", options->cameraFile,
                       "instead of the dataset's camera.yaml; its depth_camera is where to start");
    parser->add_option("--frames", options->frames, "\"a:b\": frames from a on and before b");
    parser->add_option("--every", options->every, "use every n-th frame");
    addOutput(*parser, {options->out, options->quiet, options->json},
              "out/calibrate-depth-<dataset>");
    return {parser, [options, &interrupted = invocation.interrupted] {
                if (options->out.empty()) {
                    options->out = "out/calibrate-depth-" + folderName(options->dataset);
                }
                return runCalibrateDepth(*options, interrupted);
            }};
}

}  // namespace photonav
