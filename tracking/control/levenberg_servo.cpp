// SPDX-License-Identifier: BSD-3-Clause
#include "control/levenberg_servo.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

namespace photonav {

LevenbergServo::LevenbergServo(View goal, const Camera& camera, Eigen::MatrixXd freedom,
                               const LevenbergServoOptions& options)
    : goal_(std::move(goal)), freedom_(std::move(freedom)), options_(options) {
    if (freedom_.rows() != 6 || freedom_.cols() < 1 || freedom_.cols() > 6) {
        throw std::invalid_argument("LevenbergServo: 1 to 6 velocities");
    }
    rows_.resize(freedom_.cols(), goal_.intensity.getSize());
    for (unsigned v = 0; v < camera.height; ++v) {
        if (options.onRow) options.onRow();
        for (unsigned u = 0; u < camera.width; ++u) {
            rows_.col(v * camera.width + u) =
                freedom_.transpose() * pixelJacobian(goal_, camera, u, v, options.photometric);
        }
    }
    H_ = rows_ * rows_.transpose();
    damped_ = H_;
    damped_.diagonal() *= 1. + options.damping;
    const double sigma = options.photometric.sigma;
    information_ = options.photometric.scale / (sigma * sigma) * H_;
}

Eigen::VectorXd LevenbergServo::velocity(const ImageF& observed) const {
    if (observed.getSize() != goal_.intensity.getSize()) {
        throw std::invalid_argument("LevenbergServo: an image of another size than the goal's");
    }
    const auto vectorOf = [](const ImageF& image) {
        return Eigen::Map<const Eigen::VectorXf>(image.bitmap, image.getSize()).cast<double>();
    };
    // A scene that has moved by dq in the camera's frame shows I = I* - L dq.
    const Eigen::VectorXd slope = rows_ * (vectorOf(observed) - vectorOf(goal_.intensity));
    return options_.gain * damped_.completeOrthogonalDecomposition().solve(slope);
}

LevenbergServo::Modes LevenbergServo::modes() const {
    constexpr double kSeen = 1.;       // information [1/m^2, 1/rad^2]; rounding leaves 1e-5
    constexpr double kNothing = 1e-9;  // rounding, of eigenvalues near 1
    const Eigen::Index n = H_.rows();
    // In units in which diag H is 1 the matrix is (C + mu)^-1 C, C with a diagonal of ones.
    Eigen::VectorXd unit(n), length(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const bool isSeen = information_(i, i) > kSeen;
        unit[i] = isSeen ? 1. / std::sqrt(H_(i, i)) : 0.;
        length[i] = isSeen ? unit[i] : 1.;
    }
    const Eigen::MatrixXd C = unit.asDiagonal() * H_ * unit.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(C);
    Modes modes{Eigen::VectorXd::Zero(n), length.asDiagonal() * solver.eigenvectors()};
    for (Eigen::Index i = 0; i < n; ++i) {
        const double lambda = solver.eigenvalues()[i];
        if (lambda > kNothing) {
            modes.rates[i] = options_.gain * lambda / (lambda + options_.damping);
        }
    }
    return modes;
}

}  // namespace photonav
