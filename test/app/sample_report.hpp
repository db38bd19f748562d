// SPDX-License-Identifier: BSD-3-Clause
// A made-up run that looks like a real one: half a floor is textured, one path goes there, the
// other one straight to the goal.
#pragma once

#include <random>

#include "report.hpp"

namespace photonav {

/// Smooth noise where x > side / 2, flat grey elsewhere; first row at the largest y.
inline ImageF sampleFloor(unsigned side) {
    ImageF image(side, side, 0.55F);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(0.F, 1.F);
    for (const unsigned cell : {24U, 12U, 6U}) {
        std::vector<float> lattice((side / cell + 2) * (side / cell + 2));
        for (float& value : lattice) value = uniform(random) - 0.5F;
        const auto corner = [&](unsigned r, unsigned c) {
            return lattice[r * (side / cell + 2) + c];
        };
        for (unsigned r = 0; r < side; ++r)
            for (unsigned c = side / 2; c < side; ++c) {
                const float y = static_cast<float>(r % cell) / static_cast<float>(cell);
                const float x = static_cast<float>(c % cell) / static_cast<float>(cell);
                const unsigned i = r / cell, j = c / cell;
                image[r][c] +=
                    0.45F * ((1 - y) * ((1 - x) * corner(i, j) + x * corner(i, j + 1)) +
                             y * ((1 - x) * corner(i + 1, j) + x * corner(i + 1, j + 1)));
            }
    }
    return image;
}

/// What a camera above (x, y) of the floor [-1, 9] x [-0.5, 9.5] sees, roughly.
inline ImageF sampleView(const ImageF& floor, const Eigen::Vector3d& position) {
    const double pixelsPerMetre = floor.getWidth() / 10.0;
    ImageF image(120, 188);
    for (unsigned v = 0; v < 120; ++v)
        for (unsigned u = 0; u < 188; ++u) {
            const double x = position.x() + 1 - (v - 59.5) * 0.0149;
            const double y = 9.5 - position.y() + (u - 93.5) * 0.0149;
            const auto clamped = [&](double m) {
                return static_cast<unsigned>(
                    std::clamp(m * pixelsPerMetre, 0.0, floor.getWidth() - 1.0));
            };
            image[v][u] = floor[clamped(y)][clamped(x)];
        }
    return image;
}

inline ImageF sampleContribution(const ImageF& image) {
    ImageF result(image.getHeight(), image.getWidth(), 0.F);
    for (unsigned v = 1; v + 1 < image.getHeight(); ++v)
        for (unsigned u = 1; u + 1 < image.getWidth(); ++u)
            result[v][u] = std::pow(image[v][u + 1] - image[v][u - 1], 2.F) +
                           std::pow(image[v + 1][u] - image[v - 1][u], 2.F);
    return result;
}

/// A path through `corners` in steps of 0.25 m whose covariance grows on grey floor and shrinks
/// over texture (x > 4).
inline DrawnPath samplePath(const std::string& name, const Color& color,
                            const std::vector<Eigen::Vector3d>& corners) {
    DrawnPath path{name, color, {}};
    Matrix6 covariance = Vector6(.004, .006, .002, 5e-6, 5e-6, 5e-5).asDiagonal();
    double distance = 0.0, cost = 0.0;
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
        const int steps =
            std::max(1, static_cast<int>((corners[i + 1] - corners[i]).norm() / 0.25));
        const double ds = (corners[i + 1] - corners[i]).norm() / steps;
        for (int k = i == 0 ? 0 : 1; k <= steps; ++k) {
            const Eigen::Vector3d at = corners[i] + (corners[i + 1] - corners[i]) * k / steps;
            Pose T_w_c = Pose::Identity();
            T_w_c.linear() << 0, -1, 0, -1, 0, 0, 0, 0, -1;  // looks down, image top towards x
            T_w_c.translation() = at;
            if (at.x() > 4.0) {
                covariance *= 0.55;
            } else {
                covariance.diagonal() += Vector6(.009, .005, .003, 4e-5, 4e-5, 1e-4) * ds;
            }
            path.points.push_back(
                makePathPoint({T_w_c.inverse(), covariance}, covariance.trace(), distance, cost));
            distance += ds;
            cost += (0.25 + 0.75 * 2.5 * covariance.trace()) * ds;
        }
    }
    return path;
}

inline DrawnTree sampleTree(int vertices) {
    DrawnTree tree;
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform(0.F, 10.F);
    std::vector<Eigen::Vector3f> nodes{{0.F, 0.F, 2.F}};
    for (int i = 0; i < vertices; ++i) {
        const Eigen::Vector3f sample(uniform(random) - 1.F, uniform(random) - 0.5F, 2.F);
        const auto nearest = *std::min_element(nodes.begin(), nodes.end(), [&](auto& a, auto& b) {
            return (a - sample).squaredNorm() < (b - sample).squaredNorm();
        });
        const float range = std::min(1.F, (sample - nearest).norm());
        nodes.push_back(nearest + range * (sample - nearest).normalized());
        tree.edges.push_back({nearest, nodes.back()});
    }
    return tree;
}

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
    data.mesh = makeReportMesh(sampleScene(floor));
    data.trees = {sampleTree(2500)};
    data.paths = {
        samplePath("belief_rrt_star", kPathColor,
                   {{0, 0, 2}, {2.5, 1.2, 2}, {5, 2.6, 2}, {5.4, 5, 2}, {4.4, 7, 2}, {2, 9, 2}}),
        samplePath("rrt_star", kBaselineColor, {{0, 0, 2}, {2, 9, 2}})};
    data.start = {0, 0, 2};
    data.goal = {2, 9, 2};
    for (std::size_t i = 0; i < data.paths[0].points.size(); i += 4) {
        const ImageF image = sampleView(floor, data.paths[0].points[i].position);
        data.views.push_back(
            {i, greyPng(image), contributionPng(image, sampleContribution(image))});
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
