// SPDX-License-Identifier: BSD-3-Clause
#include "servo/servo_result.hpp"

#include "result/json_values.hpp"

namespace photonav {
using nlohmann::json;
namespace {

json modeJson(const ServoMode& mode, double depth) {
    const auto list = [](const Vector6& v) { return std::vector<double>(v.data(), v.data() + 6); };
    return {{"direction", list(mode.direction)},
            {"in_words", inWords(mode, depth)},
            {"rate_per_s", mode.rate},
            {"decay_predicted_per_s", mode.predictedDecay},
            {"decay_simulated_per_s", finiteOrNull(mode.simulatedDecay)}};
}

json cellJson(const BasinCell& cell) {
    return {{"distance_m", cell.distance},
            {"angle_deg", cell.angle},
            {"trials", cell.trials},
            {"converged", cell.converged},
            {"share_95_percent", {cell.low, cell.high}},
            {"median_s", cell.converged > 0 ? json(cell.seconds) : json(nullptr)}};
}

}  // namespace

json servoOptionsJson(const ServoStudyOptions& options, const Camera& camera) {
    return {{"degrees_of_freedom", options.hasTilt ? 6 : 4},
            {"gain", options.gain},
            {"damping", options.damping},
            {"image_rate", options.rate},
            {"image_width", camera.width}};
}

json servoStudyJson(const ServoStudy& study) {
    json modes = json::array(), cells = json::array();
    for (const ServoMode& mode : study.modes) modes.push_back(modeJson(mode, study.depth));
    for (const BasinCell& cell : study.basin) cells.push_back(cellJson(cell));
    return {{"condition", finiteOrNull(study.condition)},
            {"position_sigma_m", finiteOrNull(study.positionSigma)},
            {"rotation_sigma_rad", finiteOrNull(study.rotationSigma)},
            {"modes", modes},
            {"basin", cells}};
}

json servoResult(const ServoGoal& goal, const ServoStudyOptions& options, const ServoStudy& study) {
    json result = resultJson(
        "servo",
        {{"interrupted", study.interrupted},
         {"goal", {{"position", vectorJson(goal.T_w_b.translation())}, {"depth_m", study.depth}}},
         {"servo", servoOptionsJson(options, goal.camera)},
         {"seed", options.seed},
         {"directions_are", "body twists x, y, z, roll, pitch, yaw [m, rad]"}});
    result.update(servoStudyJson(study));
    return result;
}

}  // namespace photonav
