// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/calibrate_depth_command.hpp"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "dataset/camera_file.hpp"
#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "io/atomic_file.hpp"
#include "io/interrupted.hpp"
#include "replay/depth_registration.hpp"
#include "result/json_values.hpp"
#include "shared/command_io.hpp"
#include "shared/result_folder.hpp"

namespace photonav {
namespace {

using nlohmann::json;

constexpr DepthCalibrationOptions kPrior;
constexpr double kOpen = 0.7;  // standard deviation of a direction that images leave open [prior's]

json resultOf(const CalibrateDepthOptions& options, const DepthRegistration& found) {
    const DepthCalibration& c = found.calibration;
    const Eigen::Quaterniond q(c.T_c_d.linear());
    const Eigen::Vector3d p = c.T_c_d.translation();
    const Vector6 sigma = c.covariance.diagonal().cwiseSqrt();
    const std::vector<double> sigmas(sigma.data(), sigma.data() + 6);
    return resultJson(
        "calibrate-depth",
        {{"dataset", options.dataset},
         {"pairs", found.pairs},
         {"unreadable", found.unreadable},
         {"T_colour_depth", {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}},
         {"sigma", sigmas},
         {"sigma_is_of", "left perturbation (rho, phi), colour camera's frame [m, rad]"},
         {"median_residual_before", c.residualBefore},
         {"median_residual_after", c.residualAfter}});
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
        const double prior = isTurn ? kPrior.rotationSigma : kPrior.translationSigma;
        table.rows.emplace_back(
            kNames.at(std::size_t(i)),
            fmt::format("{:.2f} +- {:.2f} {}{}", xi[i] / unit, sigma[i] / unit,
                        isTurn ? "deg" : "mm",
                        sigma[i] > kOpen * prior ? ", not determined by these images" : ""));
    }
    if (found.unreadable > 0) {
        table.rows.emplace_back("frames that cannot be used", std::to_string(found.unreadable));
    }
    table.rows.emplace_back("pairs of images", std::to_string(found.pairs));
    table.rows.emplace_back("median residual", fmt::format("{:.5f} (before {:.5f})",
                                                           c.residualAfter, c.residualBefore));
    return table;
}

}  // namespace

CommandReport runCalibrateDepth(const CalibrateDepthOptions& options,
                                const std::atomic<bool>& interrupted) {
    FolderTransaction folder = beginResult(options.out, {options.dataset, options.cameraFile});
    const DepthRegistration found = registerDepth(
        options, [&] { return interrupted.load(); }, options.progress);
    if (found.isInterrupted) throw Interrupted();  // half of the pairs are no calibration
    CommandReport report{{}, resultOf(options, found), summaryOf(found), kDone};
    writeFileAtomically(folder.path() / "camera.yaml", cameraYaml(found.sequence));
    report.folder = commitResult(folder, report.result);
    return report;
}

}  // namespace photonav
