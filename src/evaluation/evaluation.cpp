// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/evaluation.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "geometry/se3.hpp"

namespace photonav {
namespace {

constexpr double kSlack = 0.1;     // share of the requested spacing
constexpr double kMinSpread = 5.;  // see alignmentOf()

double angleOf(const Pose& T) { return Eigen::AngleAxisd(T.linear()).angle(); }

void add(PoseErrors& errors, const Pose& error) {
    errors.translation.push_back(error.translation().norm());
    errors.rotation.push_back(angleOf(error));
}

/// The coordinate of every pose in the unit of the spacing: frame number, time, or path length.
std::vector<double> places(const std::vector<PosePair>& pairs, Spacing spacing) {
    std::vector<double> result;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (spacing == Spacing::frames) {
            result.push_back(static_cast<double>(pairs[i].frame));
        } else if (spacing == Spacing::seconds) {
            result.push_back(pairs[i].timestamp);
        } else {
            const double step =
                i == 0
                    ? 0.
                    : (pairs[i].T_w_c_truth.translation() - pairs[i - 1].T_w_c_truth.translation())
                          .norm();
            result.push_back(i == 0 ? 0. : result.back() + step);
        }
    }
    return result;
}

/// Standard deviation of points along the second of their principal axes.
double secondSpread(const std::vector<Eigen::Vector3d>& points) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& p : points) mean += p / double(points.size());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const auto& p : points) {
        scatter += (p - mean) * (p - mean).transpose() / double(points.size());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter, Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0., solver.eigenvalues()[1]));
}

/// The rotation R with the largest trace of R^T M (Umeyama 1991, eq. 40). With matrices of fixed
/// size, unlike Eigen::umeyama: functions of dynamic matrices that we export would replace those in
/// OMPL's library, which was compiled for another memory alignment.
Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& M) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d signs = Eigen::Vector3d::Ones();
    signs[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0. ? -1. : 1.;
    return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

/// The mean rotation (in the chordal sense) between the orientations, and the mean translation.
Pose alignmentOfOrientations(const std::vector<PosePair>& pairs) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const PosePair& pair : pairs) {
        sum += pair.T_w_c_truth.linear() * pair.T_w_c_estimate.linear().transpose();
    }
    Pose T = Pose::Identity();
    T.linear() = nearestRotation(sum);
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    for (const PosePair& pair : pairs) {
        shift += (pair.T_w_c_truth.translation() - T * pair.T_w_c_estimate.translation()) /
                 double(pairs.size());
    }
    T.translation() = shift;
    return T;
}

}  // namespace

ErrorSummary summarise(std::vector<double> errors) {
    ErrorSummary summary;
    summary.count = errors.size();
    if (errors.empty()) return summary;
    std::sort(errors.begin(), errors.end());
    const double squares = std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.);
    summary.rmse = std::sqrt(squares / static_cast<double>(errors.size()));
    const auto quantile = [&](double q) {
        return errors[static_cast<std::size_t>(
            std::lround(q * static_cast<double>(errors.size() - 1)))];
    };
    summary.median = quantile(0.5);
    summary.p90 = quantile(0.9);
    summary.max = errors.back();
    return summary;
}

Pose rigidAlignment(const std::vector<Eigen::Vector3d>& from,
                    const std::vector<Eigen::Vector3d>& to) {
    if (from.size() != to.size() || from.empty()) {
        throw std::invalid_argument("rigidAlignment: as many points here as there, at least one");
    }
    Eigen::Vector3d meanFrom = Eigen::Vector3d::Zero();
    Eigen::Vector3d meanTo = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < from.size(); ++i) {
        meanFrom += from[i] / double(from.size());
        meanTo += to[i] / double(to.size());
    }
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < from.size(); ++i) {
        covariance += (to[i] - meanTo) * (from[i] - meanFrom).transpose();
    }
    Pose T = Pose::Identity();
    if (from.size() > 1) T.linear() = nearestRotation(covariance);
    T.translation() = meanTo - T.linear() * meanFrom;
    return T;
}

Pose positionAlignment(const std::vector<PosePair>& pairs) {
    std::vector<Eigen::Vector3d> estimate;
    std::vector<Eigen::Vector3d> truth;
    for (const PosePair& pair : pairs) {
        estimate.emplace_back(pair.T_w_c_estimate.translation());
        truth.emplace_back(pair.T_w_c_truth.translation());
    }
    return rigidAlignment(estimate, truth);
}

Pose alignmentOf(const std::vector<PosePair>& pairs) {
    const Pose T = positionAlignment(pairs);
    const double left = summarise(absoluteErrors(pairs, T).translation).rmse;
    std::vector<Eigen::Vector3d> truth;
    truth.reserve(pairs.size());
    for (const PosePair& pair : pairs) truth.emplace_back(pair.T_w_c_truth.translation());
    return secondSpread(truth) > kMinSpread * left + 1e-9 ? T : alignmentOfOrientations(pairs);
}

PoseErrors absoluteErrors(const std::vector<PosePair>& pairs, const Pose& T_truth_estimate) {
    PoseErrors errors;
    for (const PosePair& pair : pairs) {
        add(errors, pair.T_w_c_truth.inverse() * T_truth_estimate * pair.T_w_c_estimate);
    }
    return errors;
}

PoseErrors relativeErrors(const std::vector<PosePair>& pairs, Spacing spacing, double delta) {
    const std::vector<double> place = places(pairs, spacing);
    PoseErrors errors;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const double wanted = place[i] + delta;
        auto j = std::lower_bound(place.begin() + std::ptrdiff_t(i) + 1, place.end(), wanted);
        if (j != place.begin() + std::ptrdiff_t(i) + 1 &&
            (j == place.end() || wanted - *(j - 1) < *j - wanted)) {
            --j;
        }
        if (j == place.end() || std::abs(*j - wanted) > kSlack * delta) continue;
        const PosePair& a = pairs[i];
        const PosePair& b = pairs[std::size_t(j - place.begin())];
        const Pose truth = a.T_w_c_truth.inverse() * b.T_w_c_truth;
        const Pose estimate = a.T_w_c_estimate.inverse() * b.T_w_c_estimate;
        add(errors, truth.inverse() * estimate);
    }
    return errors;
}

std::optional<double> squaredNormalisedError(const UncertainPose& T_c_w, const Pose& T_c_w_truth) {
    const Vector6 e = deviation(T_c_w_truth, T_c_w.mean);
    const Eigen::LLT<Matrix6> llt(transported(T_c_w.covariance, e));
    if (llt.info() != Eigen::Success) return {};
    return e.dot(llt.solve(e));
}

std::optional<NormalisedError> normalisedError(const UncertainPose& T_c_w,
                                               const Pose& T_c_w_truth) {
    const auto squared = squaredNormalisedError(T_c_w, T_c_w_truth);
    if (!squared) return {};
    const Vector6 xi = deviation(T_c_w_truth, T_c_w.mean);
    const Matrix6 covariance = transported(T_c_w.covariance, xi);
    const auto part = [&](int begin) {
        const Eigen::Vector3d e = xi.segment<3>(begin);
        return e.dot(covariance.block<3, 3>(begin, begin).llt().solve(e)) / 3.;
    };
    const Vector6 sigmas = covariance.diagonal().cwiseSqrt();
    return NormalisedError{*squared / 6., part(0), part(3),
                           xi.cwiseQuotient(sigmas).cwiseAbs().maxCoeff()};
}

}  // namespace photonav
