// SPDX-License-Identifier: BSD-3-Clause
// Light that changes slowly over the image, estimated together with the pose.
#pragma once

#include <vector>

#include "alignment/normal_equations.hpp"

namespace photonav {

/// A gain that varies over the image, a polynomial of second order: the vignetting of a lens, or
/// light that falls otherwise than when the model was made. The mean over the image belongs to the
/// exposure. Where the field is unknown, the pose absorbs it: by millimetres to centimetres over
/// little texture, alike in every image, and no residual shows it. So the field is eliminated from
/// the normal equations, as the exposure is. For the other unknowns x (pose, gain, offset) the most
/// likely field has the coefficients constant + slope x.
///
/// The gain of a block is that in its middle. Residuals are those without a field, and x is a step
/// from the pose and exposure at which the blocks were compared.
class LightField {
  public:
    /// @param camera camera of the level at which the blocks were compared
    /// @param sigma standard deviation of each term of the field where it is largest, at the edge
    ///        of the image [share of the light]; 0: there is no field
    /// @param noise variance of a pixel [grey value^2]. It is raised to what the blocks show, or a
    ///        field would follow the errors of a model in small parts of the image.
    LightField(const std::vector<ImageBlock>& blocks, const Camera& camera, double sigma,
               double noise);

    /// The equations for x if the field is the most likely one. The sums over the blocks, with
    /// priorAtA() and priorAtr(), are the Schur complement of the equations for x and the field.
    std::vector<ImageBlock> eliminatedFrom(std::vector<ImageBlock> blocks) const;
    /// The same for the sums over the whole image, prior included. The loss is that at x = 0.
    NormalEquations eliminatedFrom(NormalEquations e) const;
    /// The part of a change of the block's Atr that no field explains.
    /// @param change of Atr, caused by an error of the model
    Vector8 unexplained(const ImageBlock& block, const Vector8& change) const {
        return change + slope_.transpose() * termsAt(block) * change[6];
    }
    /// Atr of a block that is left at x and at the field of x.
    Vector8 residual(const ImageBlock& block, const Vector8& x) const;

    /// The variance of a pixel by which the prior weighs.
    double noise() const { return noise_; }
    Matrix8 priorAtA() const { return known_ * slope_.transpose() * slope_; }
    Vector8 priorAtr() const { return -known_ * slope_.transpose() * constant_; }
    /// Covariance of the sum of Atr by fields that are as large as the prior says.
    Matrix8 priorScatter() const { return noise_ * priorAtA(); }

  private:
    static constexpr int kTerms = 5;
    using Terms = Eigen::Matrix<double, kTerms, 1>;

    using Square = Eigen::Matrix<double, kTerms, kTerms>;

    Terms termsAt(const ImageBlock& block) const;
    void fit(const std::vector<ImageBlock>& blocks, double sigma);
    double noiseIn(const std::vector<ImageBlock>& blocks) const;

    Eigen::Array2d size_;  ///< of the image [blocks]
    double noise_;
    double known_ = 0.;  ///< the prior's information about a coefficient, multiplied by `noise_`
    Square information_ = Square::Zero();  ///< about the coefficients, multiplied by `noise_`
    Eigen::Matrix<double, kTerms, 8> slope_ = Eigen::Matrix<double, kTerms, 8>::Zero();
    Terms constant_ = Terms::Zero();
};

}  // namespace photonav
