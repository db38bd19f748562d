// SPDX-License-Identifier: BSD-3-Clause
#include "control/view_search.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "alignment/hole_margin.hpp"

namespace photonav {
namespace {

constexpr double kNarrowed = 0.5;       // share of the variance that an image leaves
constexpr double kSearchedSigmas = 3.;  // standard deviations
constexpr int kDirections = 8;          // of the places around one

struct WidestDirection {
    Eigen::Vector3d axis_c;
    double variance = 0.;  // [m^2]
};

WidestDirection widestDirection(const Matrix6& covariance) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance.topLeftCorner<3, 3>());
    return {solver.eigenvectors().col(2), std::max(0., solver.eigenvalues()[2])};
}

}  // namespace

bool isLineFree(const Eigen::Vector3d& from_w, const Eigen::Vector3d& to_w, const IsFree& isFree) {
    constexpr double kStep = 0.05;  // [m]
    const int steps = 1 + static_cast<int>((to_w - from_w).norm() / kStep);
    for (int i = 0; i <= steps; ++i) {
        if (!isFree(from_w + (to_w - from_w) * i / steps)) return false;
    }
    return true;
}

double widestSigma(const Matrix6& covariance) {
    return std::sqrt(widestDirection(covariance).variance);
}

bool ViewSearch::narrows(const UncertainPose& belief, const Pose& T_w_b) const {
    const WidestDirection widest = widestDirection(belief.covariance);
    Vector6 axis = Vector6::Zero();
    axis.head<3>() = widest.axis_c;
    View view;
    for (const double sigmas : {-1., 0., 1.}) {
        Pose T_c_w = (T_w_b * T_b_c_).inverse();
        T_c_w.translation() += sigmas * std::sqrt(widest.variance) * widest.axis_c;
        map_->render(camera_, T_c_w, view);
        widenHoles(view, holeMargin(belief.covariance, camera_, meanDepth(view)));
        const Matrix6 left = updateCovariance(belief.covariance,
                                              photometricInformation(view, camera_, photometric_));
        if (axis.dot(left * axis) > kNarrowed * widest.variance) return false;
    }
    return true;
}

std::optional<Pose> ViewSearch::nearest(const UncertainPose& belief, const Pose& T_w_b,
                                        const IsFree& isFree) const {
    const Eigen::Vector3d from_w = (T_b_c_ * belief.mean).inverse().translation();
    const double step = 0.25 * footprint(T_w_b);
    const int rings = 4 + static_cast<int>(kSearchedSigmas * widestSigma(belief.covariance) / step);
    for (int ring = 0; ring <= rings; ++ring) {
        for (int i = 0; i < (ring > 0 ? kDirections : 1); ++i) {
            const double angle = 2. * std::numbers::pi * i / kDirections;
            Pose place = T_w_b;
            place.translation() +=
                ring * step * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.);
            if (wasVisited(place, 0.5 * step)) continue;
            if (isLineFree(from_w, place.translation(), isFree) && narrows(belief, place))
                return place;
        }
    }
    return {};
}

/// Smaller side of what the camera sees [m].
double ViewSearch::footprint(const Pose& T_w_b) const {
    View view;
    map_->render(camera_, (T_w_b * T_b_c_).inverse(), view);
    return meanDepth(view) * camera_.height / camera_.fy();
}

bool ViewSearch::wasVisited(const Pose& T_w_b, double apart) const {
    for (const Eigen::Vector3d& visited_w : visited_) {
        if ((visited_w - T_w_b.translation()).norm() < apart) return true;
    }
    return false;
}

}  // namespace photonav
