// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/light_field.hpp"

#include <algorithm>
#include <cmath>

namespace photonav {

LightField::LightField(const std::vector<ImageBlock>& blocks, const Camera& camera, double sigma,
                       double noise)
    : size_(ImageBlock::numberIn(camera).cast<double>()), noise_(noise) {
    if (!(sigma > 0.)) return;
    fit(blocks, sigma);
    noise_ = std::max(noise, noiseIn(blocks));
    fit(blocks, sigma);
}

void LightField::fit(const std::vector<ImageBlock>& blocks, double sigma) {
    known_ = noise_ / (sigma * sigma);
    information_ = known_ * Square::Identity();
    slope_.setZero();
    constant_.setZero();
    for (const ImageBlock& block : blocks) {
        const Terms terms = termsAt(block);
        information_ += block.AtA(6, 6) * terms * terms.transpose();
        slope_ -= terms * block.AtA.row(6);
        constant_ += terms * block.Atr[6];
    }
    const Eigen::LLT<Square> cholesky(information_);
    cholesky.solveInPlace(slope_);
    cholesky.solveInPlace(constant_);
}

/// Variance of a pixel by the gains of the blocks about their mean, if the pixels of a block were
/// independent.
double LightField::noiseIn(const std::vector<ImageBlock>& blocks) const {
    double sum = 0., squares = 0., weight = 0., count = 0.;
    for (const ImageBlock& block : blocks) {
        const double known = block.AtA(6, 6);
        if (!(known > 0.)) continue;
        const double left = residual(block, Vector8::Zero())[6];
        sum += left;
        squares += left * left / known;
        weight += known;
        count += 1.;
    }
    const double free = count - kTerms - 1.;
    return free > 0. ? std::max(0., squares - sum * sum / weight) / free : 0.;
}

/// Legendre's polynomials up to the second order, from -1 to 1 over the image.
LightField::Terms LightField::termsAt(const ImageBlock& block) const {
    const Eigen::Array2d p = 2. * (block.index.cast<double>() + 0.5) / size_ - 1.;
    const Eigen::Array2d second = 1.5 * p.square() - 0.5;
    Terms terms;
    terms << p.x(), p.y(), second.x(), second.y(), p.prod();
    return terms;
}

std::vector<ImageBlock> LightField::eliminatedFrom(std::vector<ImageBlock> blocks) const {
    if (known_ == 0.) return blocks;  // there is no field
    for (ImageBlock& block : blocks) {
        const Terms terms = termsAt(block);
        Matrix8 withField = Matrix8::Identity();  // the block's gain follows x
        withField.row(6) += terms.transpose() * slope_;
        block.Atr = withField.transpose() * (block.Atr - block.AtA.col(6) * terms.dot(constant_));
        block.AtA = (withField.transpose() * block.AtA * withField).eval();
    }
    return blocks;
}

NormalEquations LightField::eliminatedFrom(NormalEquations e) const {
    const double gained = constant_.dot(information_ * constant_);
    e.AtA -= slope_.transpose() * information_ * slope_;
    e.Atr += slope_.transpose() * information_ * constant_;
    e.loss -= gained;
    e.sumSquares -= gained;
    return e;
}

Vector8 LightField::residual(const ImageBlock& block, const Vector8& x) const {
    const double gain = termsAt(block).dot(constant_ + slope_ * x);
    return block.Atr - block.AtA * x - block.AtA.col(6) * gain;
}

}  // namespace photonav
