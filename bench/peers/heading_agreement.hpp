// SPDX-License-Identifier: BSD-3-Clause
// Where information models agree about the best heading at a position, and how much information
// another model's heading loses.
#pragma once

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "../statistics.hpp"
#include "geometry/constants.hpp"
#include "geometry/uncertain_pose.hpp"

namespace photonav::peers {

constexpr int kHeadings = 72;

inline double headingOf(int k) { return 2. * std::numbers::pi * k / kHeadings; }

using AtPosition = std::array<Matrix6, kHeadings>;  ///< camera frame, by heading
using HeadingInformation = std::vector<AtPosition>;
using HeadingScores = std::vector<std::array<double, kHeadings>>;

/// A score of information by which headings are compared, and the share of our best information
/// that is left, in [0, 1], from the scores of a heading and of the best.
struct Criterion {
    std::string name;
    std::function<double(const Matrix6& information)> score;
    std::function<double(double chosen, double best)> share;
};

/// log det, from the eigenvalues that are not negative.
inline double logDet(const Matrix6& information) {
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(information, Eigen::EigenvaluesOnly);
    return solver.eigenvalues().cwiseMax(1e-9).array().log().sum();
}

/// @param prior covariance of the pose before the view, camera frame, for the last criterion
inline std::vector<Criterion> criteriaOf(const Matrix6& prior) {
    const Matrix6 priorInformation = prior.inverse();
    const auto posterior = [priorInformation](const Matrix6& information) {
        const Eigen::SelfAdjointEigenSolver<Matrix6> solver(information);
        const Matrix6 positive = solver.eigenvectors() *
                                 solver.eigenvalues().cwiseMax(0.).asDiagonal() *
                                 solver.eigenvectors().transpose();
        return -weightedTrace((priorInformation + positive).inverse());
    };
    return {{"trace", [](const Matrix6& information) { return information.trace(); },
             [](double chosen, double best) { return chosen / best; }},
            {"log det", logDet,
             [](double chosen, double best) { return std::exp((chosen - best) / 6.); }},
            {"trace of the covariance after the view", posterior,
             [](double chosen, double best) { return best / chosen; }}};
}

inline HeadingScores scoresOf(const HeadingInformation& informations, const Criterion& criterion) {
    HeadingScores scores;
    for (const AtPosition& at : informations) {
        std::transform(at.begin(), at.end(), scores.emplace_back().begin(), criterion.score);
    }
    return scores;
}

/// Scores whose best heading is random, as a baseline.
inline HeadingScores randomScores(std::size_t positions) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(0., 1.);
    HeadingScores scores(positions);
    for (auto& at : scores) {
        for (double& score : at) score = uniform(random);
    }
    return scores;
}

inline double medianTrace(const HeadingInformation& informations) {
    std::vector<double> traces;
    for (const AtPosition& at : informations) {
        for (const Matrix6& information : at) traces.push_back(information.trace());
    }
    return quantile(traces, 0.5);
}

inline void printAgreementHeading(const Criterion& criterion) {
    fmt::print("\n{:<56}{:>14}{:>14}{:>14}{:>18}\n", "best heading by " + criterion.name,
               "median angle", "within 20", "mean share", "10th percentile");
}

/// The angle between the best headings, and the share of our information at the other's heading.
inline void printAgreement(const std::string& name, const HeadingScores& ours,
                           const HeadingScores& other, const Criterion& criterion) {
    const auto bestOf = [](const auto& at) {
        return static_cast<int>(std::max_element(at.begin(), at.end()) - at.begin());
    };
    std::vector<double> angles, shares;
    double sum = 0.;
    int near = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
        const int best = bestOf(ours[i]), chosen = bestOf(other[i]);
        const int steps = std::abs(best - chosen);
        angles.push_back(360. / kHeadings * std::min(steps, kHeadings - steps));
        near += angles.back() <= 20. ? 1 : 0;
        shares.push_back(criterion.share(ours[i][chosen], ours[i][best]));
        sum += shares.back();
    }
    const auto count = static_cast<double>(ours.size());
    fmt::print("{:<56}{:>14.0f}{:>12.0f} %{:>14.2f}{:>18.2f}\n", name, quantile(angles, 0.5),
               100. * near / count, sum / count, quantile(shares, 0.1));
}

}  // namespace photonav::peers
