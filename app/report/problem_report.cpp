// SPDX-License-Identifier: BSD-3-Clause
#include "report/problem_report.hpp"

namespace photonav {

void describeWorld(const World& world, ReportData& report) {
    if (world.scene() != nullptr) report.mesh = drawnMesh(*world.scene());
    if (world.map() != nullptr) report.voxels = drawnVoxels(*world.map());
}

ReportData problemReport(const Config& config, const World& world, const std::string& commandLine,
                         const nlohmann::json& result) {
    ReportData report;
    report.commandLine = commandLine;
    report.result = result;
    report.config = toYaml(config);
    report.start = config.start.position;
    report.goal = config.goal.position;
    report.fieldOfView = fieldOfView(config.camera.camera());
    describeWorld(world, report);
    return report;
}

}  // namespace photonav
