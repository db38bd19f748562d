// SPDX-License-Identifier: BSD-3-Clause
// A made-up run that looks like a real one: half a floor is textured, one path goes there, the
// other one straight to the goal.
#pragma once

#include <random>

#include "shapes/paths.hpp"

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

/// A path over the texture, and a straight one.
inline std::vector<DrawnPath> samplePaths() {
    return {
        samplePath("belief_rrt_star", plannerColor("belief_rrt_star"),
                   {{0, 0, 2}, {2.5, 1.2, 2}, {5, 2.6, 2}, {5.4, 5, 2}, {4.4, 7, 2}, {2, 9, 2}}),
        samplePath("rrt_star", plannerColor("rrt_star"), {{0, 0, 2}, {2, 9, 2}})};
}

}  // namespace photonav
