// SPDX-License-Identifier: BSD-3-Clause
// Photometric servoing by the law of Levenberg and Marquardt, and how it converges.
#pragma once

#include <functional>

#include "photometry/photometric.hpp"

namespace photonav {

struct LevenbergServoOptions {
    PhotometricOptions photometric = {};
    double gain = 1.;       ///< of the error's exponential decrease [1/s]
    double damping = 0.01;  ///< mu; 0: Gauss-Newton
    /// Called before each row of the goal's image, which takes seconds if it is large; may throw to
    /// end that.
    std::function<void()> onRow = {};
};

/// The law of Collewet and Marchand (2011) with the interaction matrix at the goal,
///     q' = gain (H + mu diag H)^-1 L^T (I - I*),   H = L^T L,
/// for velocities q' of some degrees of freedom. To first order, the error dq = q - q(goal) then
/// follows dq' = -gain (H + mu diag H)^-1 H dq.
class LevenbergServo {
  public:
    /// @param goal the view of the camera at the goal
    /// @param freedom 6 x n: the twist of T_c_w on its left that each velocity makes,
    ///        T_c_w' = exp(freedom q' dt) T_c_w
    /// @throws std::invalid_argument unless there are 1 to 6 columns
    LevenbergServo(View goal, const Camera& camera, Eigen::MatrixXd freedom,
                   const LevenbergServoOptions& options);

    /// Velocities q'; zero in directions that the goal's view does not determine.
    Eigen::VectorXd velocity(const ImageF& observed) const;

    const Eigen::MatrixXd& freedom() const { return freedom_; }
    const View& goal() const { return goal_; }
    /// H, scaled to the information of one image.
    const Eigen::MatrixXd& information() const { return information_; }

    /// Directions of the error that converge independently, each at its own rate; the slowest
    /// first.
    struct Modes {
        Eigen::VectorXd rates;       ///< [1/s]; 0: never
        Eigen::MatrixXd directions;  ///< column by column, in q, of any length
    };
    /// Eigenvectors of gain (H + mu diag H)^-1 H.
    Modes modes() const;

  private:
    View goal_;
    Eigen::MatrixXd freedom_;
    LevenbergServoOptions options_;
    Eigen::MatrixXd rows_;  ///< L: a pixel's change of intensity with dq, by columns
    Eigen::MatrixXd information_;
    Eigen::MatrixXd H_, damped_;
};

}  // namespace photonav
