// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/certain_information.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "geometry/eigensystem.hpp"

namespace photonav {
namespace {

constexpr double kOfEdges = 0.04;
constexpr float kRight = 0.5F, kDown = 0.25F;  // shift of the principal point [pixels]
constexpr double kSingular = 1e-6;             // eigenvalue of a matrix whose diagonal is one

bool isInvertible(const Matrix6& A) {
    if ((A.diagonal().array() <= 0.).any()) return false;
    const Vector6 unit = A.diagonal().cwiseSqrt().cwiseInverse();
    return eigensystem(unit.asDiagonal() * A * unit.asDiagonal()).values[0] > kSingular;
}

}  // namespace

Camera betweenPixels(const Camera& camera) {
    Camera between = camera;
    between.intrinsics =
        vpCameraParameters(camera.fx(), camera.fy(), camera.cx() + kRight, camera.cy() + kDown);
    return between;
}

ImageF atPixels(const ImageF& between) {
    const unsigned height = between.getHeight(), width = between.getWidth();
    ImageF image(height, width);
    for (unsigned v = 0; v < height; ++v) {
        const float* upper = between[v];
        const float* lower = between[std::min(v + 1, height - 1)];
        const auto column = [&](unsigned u) { return upper[u] + kDown * (lower[u] - upper[u]); };
        for (unsigned u = 0; u < width; ++u) {
            const float left = column(u), right = column(std::min(u + 1, width - 1));
            image[v][u] = left + kRight * (right - left);
        }
    }
    return image;
}

double certainShare(const std::vector<GradientTile>& tiles) {
    Matrix6 all = Matrix6::Zero(), certain = Matrix6::Zero();
    for (const GradientTile& tile : tiles) {
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> along;
        along.computeDirect(tile.model, Eigen::EigenvaluesOnly);
        const double ofEdges = kOfEdges * along.eigenvalues()[1];
        const TileMotion motion(tile);
        all += motion.squared(tile.model);
        certain += motion.squared(tile.shared - ofEdges * Eigen::Matrix2d::Identity());
    }
    if (!isInvertible(all)) return 0.;
    return std::clamp(eigensystem(certain, all).values[0], 0., 1.);
}

}  // namespace photonav
