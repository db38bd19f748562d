// SPDX-License-Identifier: BSD-3-Clause
// Correction for the image noise in a model that was made of images. Noise has gradients, so that a
// blank wall would seem to determine the camera pose.
#pragma once

#include "alignment/normal_equations.hpp"

namespace photonav {

/// Estimates the contribution N of noise to AtA. The part of the gradients that model and image
/// share is texture, the rest is noise. The variance of the noise gradients is measured for each
/// axis of the image; N follows from the geometry of the points,
///     N = sum var(gx) Du^T Du + var(gy) Dv^T Dv,
/// where Du and Dv are the derivatives of a point's pixel coordinates by the pose.
class GradientNoise {
  public:
    /// Adds a point that was used. All points are added, or a representative sample.
    /// @param x,y normalised image coordinates
    /// @param inverseDepth [1/m]
    void add(double x, double y, double inverseDepth);

    /// Subtracts N from the equations. With A = J^T J by the noisy gradients g + n, the right side
    /// b = J^T r is about (A - N) xi with covariance A (times the variance of r). The information
    /// of the estimate (A - N)^-1 b is therefore (A - N) A^-1 (A - N). In the basis where N = 1 and
    /// A = diag(mu) this multiplies J by 1 - 1/mu; directions with mu < 1 have no information.
    /// @param notShared sums over the points of g (g - observed g), for x and y, in the units of J
    ///        before `unit`
    /// @param most upper limit of the variance of a component of g by noise, before a margin for
    ///        chance is added
    /// @param unit factors on the columns of J
    /// @return D, with which the equations became D^T AtA D and D^T Atr
    Matrix8 subtractFrom(NormalEquations& e, const Eigen::Vector2d& notShared, double most,
                         const Vector6& unit) const;

  private:
    Matrix6 ofX_ = Matrix6::Zero(), ofY_ = Matrix6::Zero();
    double points_ = 0.;
};

}  // namespace photonav
