// SPDX-License-Identifier: BSD-3-Clause
#include "report/problem_report.hpp"

#include "dataset/image_file.hpp"
#include "figures/images.hpp"

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

std::vector<ReportView> reportViews(const Config& config, const World& world,
                                    const EvaluatedPath& path,
                                    const std::vector<std::size_t>& points) {
    const Camera camera = config.camera.camera();
    std::vector<ReportView> views;
    View view;
    for (const std::size_t i : points) {
        const Pose T_c_w = (path.points[i].T_w_b * config.camera.T_b_c()).inverse();
        world.views().render(camera, T_c_w, view);
        views.push_back(
            {i, greyPng(view.intensity),
             pngOf(contributionPicture(view.intensity,
                                       contributionImage(view, camera, config.photometric)))});
    }
    return views;
}

}  // namespace photonav
