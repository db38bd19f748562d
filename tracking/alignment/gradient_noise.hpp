// SPDX-License-Identifier: BSD-3-Clause
// A model made of images has their noise, and noise has gradients too: a blank wall would seem to
// pin the camera.
#pragma once

#include "alignment/normal_equations.hpp"

namespace photonav {

/// What the gradients of model and image share is texture, what they do not is noise. Its variance
/// is measured for either axis of the image, and what it adds to AtA follows from geometry,
///     N = sum var(gx) Du^T Du + var(gy) Dv^T Dv,
/// Du and Dv the motion of a point in the image by the pose.
class GradientNoise {
  public:
    /// A point that counts, all of them or a fair sample: normalised coordinates and inverse depth.
    void add(double x, double y, double inverseDepth);

    /// Subtracts N from the equations. With gradients g + n, b = A^T r is about (A - N) xi, and its
    /// covariance is A: of the estimate (A - N)^-1 b the information is (A - N) A^-1 (A - N). In
    /// the basis where N = 1 and A = diag(mu) this scales both equations by 1 - 1/mu; directions
    /// with mu < 1 say nothing.
    /// @param notShared sums over the points of g (g - seen g), x and y, in the units of J before
    ///        `unit`
    /// @param most variance of a component of g, if it were of nothing but noise; a little more,
    /// for
    ///        chance, is subtracted
    /// @param unit what J's columns are to be multiplied by
    void subtractFrom(NormalEquations& e, const Eigen::Vector2d& notShared, double most,
                      const Vector6& unit) const;

  private:
    Matrix6 ofX_ = Matrix6::Zero(), ofY_ = Matrix6::Zero();
    double points_ = 0.;
};

}  // namespace photonav
