// SPDX-License-Identifier: BSD-3-Clause
// The report of a made-up run.
#pragma once

#include "dataset/image_file.hpp"
#include "drawing/figures/sample_run.hpp"
#include "figures/images.hpp"
#include "report/report.hpp"

namespace photonav {

inline Scene sampleScene(const ImageF& floor) {
    Scene scene;
    scene.textures = {{floor}, {ImageF(2, 2, 0.8F)}};
    const Eigen::Vector3f a(-1, -0.5, 0), b(9, -0.5, 0), c(9, 9.5, 0), d(-1, 9.5, 0);
    const Eigen::Vector3f up(0, 0, 0.6F);
    scene.triangles = {{{a, b, c}, {{{0, 1}, {1, 1}, {1, 0}}}, 0},
                       {{a, c, d}, {{{0, 1}, {1, 0}, {0, 0}}}, 0},
                       {{d, c, c + up}, {{{0, 0}, {1, 0}, {1, 1}}}, 1},
                       {{d, c + up, d + up}, {{{0, 0}, {1, 1}, {0, 1}}}, 1}};
    return scene;
}

inline ReportData sampleReport() {
    const ImageF floor = sampleFloor(480);
    ReportData data;
    data.title = "Two textures";
    data.subtitle =
        "belief_rrt_star searched 2500 vertices from (0, 0, 2) m to (2, 9, 2) m, alpha 0.25.";
    data.commandLine = "photonav plan config/two_textures.yaml --seed 7";
    data.version = "0.1.0";
    data.mesh = drawnMesh(sampleScene(floor));
    data.trees = {sampleTree(2500)};
    data.paths = samplePaths();
    data.paths[0].meanTrace = 0.041;
    data.paths[1].meanTrace = 0.2;
    data.start = {0, 0, 2};
    data.goal = {2, 9, 2};
    for (std::size_t i = 0; i < data.paths[0].points.size(); i += 4) {
        const ImageF image = sampleView(floor, data.paths[0].points[i].position);
        data.views.push_back(
            {i, greyPng(image), pngOf(contributionPicture(image, sampleContribution(image)))});
    }
    for (std::size_t n = 50; n <= 2500; n += 50)
        data.progress.push_back({n, 0.0006 * n, 3.9 + 40.0 / n, 30 * n});
    data.result = {
        {"schema", 1},
        {"command", "plan"},
        {"seed", 7},
        {"planner", "belief_rrt_star"},
        {"alpha", 0.25},
        {"cost", data.paths[0].points.back().cost},
        {"length", data.paths[0].points.back().distance},
        {"mean_trace", 0.041},
        {"goal_trace", data.paths[0].points.back().trace},
        {"vertices", 2500},
        {"iterations", 2618},
        {"views", 74210},
        {"cache_hits", 51877},
        {"time", {{"total_s", 1.48}, {"views_s", 1.05}, {"beliefs_s", 0.21}, {"tree_s", 0.13}}},
        {"audit", {{"max_cost_error", 2e-12}, {"max_covariance_error", 3e-15}}}};
    data.config =
        "scene:\n  file: two_textures_scene.yaml\nplanner:\n  name: belief_rrt_star\n  alpha: 0.25 "
        " # </script>\n";
    data.tables = {{"Map", {{"triangles", "4"}, {"extent", "10.0 x 10.0 x 0.6 m"}}}};
    return data;
}

}  // namespace photonav
