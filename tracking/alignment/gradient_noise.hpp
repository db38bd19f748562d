// SPDX-License-Identifier: BSD-3-Clause
// Correction for the noise of a model made of images. Noise has gradients too, so that a blank wall
// would seem to determine the camera pose.
#pragma once

#include "alignment/normal_equations.hpp"

namespace photonav {

/// The part of the gradients that model and image share is texture, the rest is noise. The noise
/// variance is measured for either axis of the image; its contribution to AtA follows from
/// geometry,
///     N = sum var(gx) Du^T Du + var(gy) Dv^T Dv,
/// where Du and Dv are the motion of a point in the image with the pose.
class GradientNoise {
  public:
    /// Adds a used point (all of them, or a representative sample): normalised coordinates and
    /// inverse depth.
    void add(double x, double y, double inverseDepth);

    /// Subtracts N from the equations. With gradients g + n, b = A^T r is about (A - N) xi, and its
    /// covariance is A. The information of the estimate (A - N)^-1 b is therefore (A - N) A^-1 (A -
    /// N). In the basis where N = 1 and A = diag(mu) this scales both equations by 1 - 1/mu;
    /// directions with mu < 1 have no information.
    /// @param notShared sums over the points of g (g - observed g), x and y, in the units of J
    ///        before `unit`
    /// @param most variance of a component of g, if g were only noise; slightly more is subtracted,
    ///        to allow for chance
    /// @param unit factors by which J's columns are to be multiplied
    /// @return D, with which the equations became D^T AtA D and D^T Atr
    Matrix8 subtractFrom(NormalEquations& e, const Eigen::Vector2d& notShared, double most,
                         const Vector6& unit) const;

  private:
    Matrix6 ofX_ = Matrix6::Zero(), ofY_ = Matrix6::Zero();
    double points_ = 0.;
};

}  // namespace photonav
