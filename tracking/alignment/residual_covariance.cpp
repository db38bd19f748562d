// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/residual_covariance.hpp"

#include <algorithm>
#include <cmath>

#include "alignment/light_field.hpp"
#include "geometry/eigensystem.hpp"

namespace photonav {
namespace {

// Not on the heap.
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
using Few = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
using Draws = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, Eigen::Dynamic>;
using Root = Eigen::Matrix<double, 8, Eigen::Dynamic, 0, 8, 6>;

/// Least eigenvalue of H, its diagonal scaled to ones, that sums in single precision can tell from
/// zero.
constexpr double kOpen = 1e-6;
constexpr double kOpenSigma = 10.;    // of directions that the image leaves open [m], [rad]
constexpr double kPixelNoise = 1e-3;  // least standard deviation of a pixel: 8 bits
constexpr double kSaturation = 0.1;   // see weightedByArea()
/// Squared difference of two estimates that is taken for chance, per degree of freedom [variances].
constexpr double kMostByChance = 2.;
/// Differences of two estimates do not matter below this share of the covariance of the pose.
constexpr double kNoDifference = 1e-3;

/// H with the prior of the exposure, which is eliminated, in coordinates y (x = V y) of the
/// directions that the image observes.
struct Observed {
    Eigen::Matrix<double, 8, 6> E =
        Eigen::Matrix<double, 8, 6>::Identity();                ///< x -> (x, exposure)
    Eigen::Matrix2d exposureInverse = Eigen::Matrix2d::Zero();  ///< of H's block
    Square V;                                                   ///< columns: directions observed
    Square solve;                                               ///< H^-1: b -> y, for b of size 6
    Square toY;                                                 ///< y of x, for x = V y
    Root root;    ///< L: L L^T is the inverse of H, without exposureInverse
    Few scale;    ///< y = diag(scale) L^T b, for b of size 8
    Square open;  ///< columns: directions not observed, of unit length
    Matrix8 scatterOfPrior = Matrix8::Zero();  ///< the exposure is as wrong as its prior says

    /// @param noise variance of a pixel, by which the prior weighs [grey value^2]
    Observed(Matrix8 H, const std::optional<ExposurePrior>& prior, double noise) {
        if (prior) {
            const double most = 1. / (kExposureSigma * kExposureSigma);
            H.diagonal().tail<2>() +=
                noise * prior->information().cwiseMax(Eigen::Vector2d::Constant(most));
            scatterOfPrior.diagonal().tail<2>() = noise * noise * prior->information();
            exposureInverse = H.bottomRightCorner<2, 2>().inverse();
            E.bottomRows<2>() = -exposureInverse * H.bottomLeftCorner<2, 6>();
        }
        const Matrix6 pose = E.transpose() * H * E;
        const Vector6 unit = pose.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
        const auto [values, vectors] = eigensystem(unit.asDiagonal() * pose * unit.asDiagonal());
        const auto missing = (values.array() < kOpen).count();
        V = unit.asDiagonal() * vectors.rightCols(6 - missing);
        solve = values.tail(6 - missing).cwiseInverse().asDiagonal() * V.transpose();
        toY = solve * pose;
        scale = values.tail(6 - missing).cwiseSqrt().cwiseInverse();
        root = E * V * scale.asDiagonal();
        open = (unit.asDiagonal() * vectors.leftCols(missing)).colwise().normalized();
    }

    Matrix8 inverse() const {
        Matrix8 result = root * root.transpose();
        result.bottomRightCorner<2, 2>() += exposureInverse;
        return result;
    }
};

/// The minimum of the image alone with the prior of the exposure, the light field eliminated.
struct Minimum {
    LightField light;
    std::vector<ImageBlock> blocks;  ///< without the field
    Matrix8 H;
    Observed seen;
    Vector8 x;  ///< the step to the minimum
};

Minimum minimumOf(const ComparedBlocks& image, const PhotometricOptions& photometric,
                  const std::optional<ExposurePrior>& prior, const ModelErrors& errors) {
    const double noise = photometric.sigma * photometric.sigma / photometric.scale;
    const LightField light(image.blocks, image.camera, errors.light, noise);
    std::vector<ImageBlock> blocks = light.eliminatedFrom(image.blocks);
    Matrix8 H = light.priorAtA();
    Vector8 gradient = light.priorAtr();
    for (const ImageBlock& block : blocks) {
        H += block.AtA;
        gradient += block.Atr;
    }
    if (prior) {
        const Eigen::Vector2d difference = ExposurePrior::difference(image.exposure);
        gradient.tail<2>() -= noise * prior->information().cwiseProduct(difference);
    }
    const Observed seen(H, prior, noise);
    return {light, std::move(blocks), H, seen, seen.inverse() * gradient};
}

/// Share of the information about a direction from which on one block counts as its only source. At
/// the minimum at most a tenth of such a block's error is left in its residuals.
constexpr double kOneBlock = 0.9;

/// Covariance of directions in which one block is the only source, as of directions that are not
/// observed, in y / Observed::scale.
Square openByOneBlock(const Minimum& minimum) {
    const Observed& seen = minimum.seen;
    const Matrix8 inverse = seen.root * seen.root.transpose();
    Square covariance = Square::Zero(seen.root.cols(), seen.root.cols());
    for (const ImageBlock& block : minimum.blocks) {
        if (block.AtA.cwiseProduct(inverse).sum() < kOneBlock) continue;  // trace of its share
        const Eigen::SelfAdjointEigenSolver<Square> share(seen.root.transpose() * block.AtA *
                                                          seen.root);
        for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
            if (share.eigenvalues()[i] < kOneBlock) continue;
            const auto direction = share.eigenvectors().col(i);
            const double length = (seen.V * seen.scale.asDiagonal() * direction).norm();
            covariance += std::pow(kOpenSigma / length, 2) * direction * direction.transpose();
        }
    }
    return covariance;
}

/// Columns: H^-1 s_b with s_b = (1 - A_b H^-1)^-1 (g_b - A_b x), in y / Observed::scale, in which H
/// is the identity: how much it changes without a block. With H^-1 = L L^T it is
/// L (1 - L^T A_b L)^-1 L^T (...), which is symmetric and smaller.
Draws changesWithout(const Minimum& minimum) {
    const std::vector<ImageBlock>& blocks = minimum.blocks;
    const Observed& seen = minimum.seen;
    const Eigen::Index size = seen.root.cols();
    Draws changes(size, static_cast<Eigen::Index>(blocks.size()));
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        const Root weighted = blocks[b].AtA.lazyProduct(seen.root);
        const Square share = seen.root.transpose().lazyProduct(weighted);
        const Square rest = (1. + kOpen) * Square::Identity(size, size) - share;
        const Vector8 gradient = blocks[b].Atr - blocks[b].AtA * minimum.x;
        const Few seenGradient = seen.root.transpose().lazyProduct(gradient);
        const Eigen::LLT<Square> cholesky(rest);
        // A block with nearly all of the information, summed in single precision, is not definite.
        const bool isDefinite = cholesky.info() == Eigen::Success;
        changes.col(static_cast<Eigen::Index>(b)) =
            isDefinite ? Few(cholesky.solve(seenGradient))
                       : Few(rest.partialPivLu().solve(seenGradient));
    }
    return changes;
}

/// Covariance of what has been drawn as often as there are columns. Estimated from few, it is too
/// small for as many dimensions as often as too large, and its inverse is too large in the mean:
/// by n / (n - d - 1), with the number n of columns that count. Below n = 2 (d + 1), where this
/// diverges, it is filled up with a covariance of the same mean that is equal in all directions.
/// @param draws in coordinates in which they are expected to scatter equally in all directions
Square covarianceOf(const Draws& draws) {
    const Square covariance = draws.lazyProduct(draws.transpose());
    const auto d = static_cast<double>(draws.rows());
    const Square equal = covariance.trace() / d * Square::Identity(draws.rows(), draws.rows());
    const Draws solved = (covariance + kOpen * equal).ldlt().solve(draws);
    const auto shares = draws.cwiseProduct(solved).colwise().sum().eval();
    if (!(shares.sum() > 0.)) return covariance;  // an exact fit
    const double n = shares.sum() * shares.sum() / shares.squaredNorm();
    const double lack = (d + 1.) / n;
    return 1. / std::max(1. - lack, 0.5) * covariance + std::max(2. * lack - 1., 0.) * equal;
}

/// The blocks with weights by which each one with more texture than noise counts alike, whatever
/// its contrast. The weights' mean over the pixels is 1.
/// @param noise variance of a pixel [grey value^2]
ComparedBlocks weightedByArea(ComparedBlocks image, double noise) {
    const double focal = image.camera.fx();
    std::vector<ImageBlock>& blocks = image.blocks;
    std::vector<double> weights;
    double sum = 0., pixels = 0.;
    for (const ImageBlock& block : blocks) {
        const double robust = std::max(1e-6, block.AtA(7, 7) / block.count);  // weight, mean
        const double gradients = (block.AtA(3, 3) + block.AtA(4, 4)) / (focal * focal * robust);
        weights.push_back(1. / (kSaturation * gradients + 0.5 * noise));
        sum += weights.back() * block.count;
        pixels += block.count;
    }
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        blocks[b].AtA *= weights[b] * pixels / sum;
        blocks[b].Atr *= weights[b] * pixels / sum;
    }
    return image;
}

/// Covariance by the difference d of two estimates of the same pose, by weights of the contrast and
/// of the area (Hausman, Specification Tests in Econometrics, 1978). Where the model
/// is right they differ by chance alone; where an object of high contrast has moved, the first one
/// follows the object, and the second one the rest of the scene. The covariance D of
/// d follows from the scatter of the blocks. The pose may be either estimate if d is larger than by
/// chance: d d^T + D, less what chance explains.
/// @param byContrast,byArea the minima of the two weights
/// @param changes changesWithout() of the first one
/// @param covariance of the pose; it and the result refer to y / Observed::scale
Square disagreement(const Minimum& byContrast, const Minimum& byArea, const Draws& changes,
                    const Square& covariance) {
    const auto size = covariance.rows();
    const Observed& seen = byContrast.seen;
    if (byArea.seen.V.cols() < size) return Square::Zero(size, size);
    const Square toScaled = seen.scale.cwiseInverse().asDiagonal() * seen.toY;
    const Few d = toScaled * (byArea.x - byContrast.x).head<6>();
    const Draws draws = toScaled * byArea.seen.root.topRows<6>() * changesWithout(byArea) - changes;
    const Square chance = covarianceOf(draws) + kNoDifference * covariance;
    const double ratio = d.dot(chance.ldlt().solve(d)) / static_cast<double>(size);
    if (!(ratio > kMostByChance)) return Square::Zero(size, size);
    return (1. - kMostByChance / ratio) * (d * d.transpose() + chance);
}

template <class Choose>
Matrix6 combined(const Matrix6& a, const Matrix6& b, const Choose& choose) {
    const auto [ratios, vectors] = eigensystem(a, b);
    const Matrix6 axes = b * vectors;  // b = axes axes^T, a = axes diag axes^T
    const Vector6 variances = ratios.unaryExpr(choose);
    return axes * variances.asDiagonal() * axes.transpose();
}

}  // namespace

MeasuredInformation measuredInformation(const ComparedBlocks& image,
                                        const PhotometricOptions& photometric,
                                        const std::optional<ExposurePrior>& prior,
                                        const ModelErrors& errors, const Pose& toModel) {
    const Minimum byContrast = minimumOf(image, photometric, prior, errors);
    const Observed& seen = byContrast.seen;
    MeasuredInformation result;
    result.repeating = kOpenSigma * kOpenSigma * seen.open * seen.open.transpose();
    if (seen.V.cols() == 0) return result;

    const auto covariance = [&](const Matrix8& scatter) -> Square {  // of y
        return seen.solve * (seen.E.transpose() * scatter * seen.E) * seen.solve.transpose();
    };
    const Square repeating =
        covariance(scatterOfRepeatingErrors(image.blocks, byContrast.light, byContrast.x, errors,
                                            image.camera)) +
        seen.toY * covarianceByScale(errors.depthScale, toModel) * seen.toY.transpose();
    const Draws changes = changesWithout(byContrast);
    const Square scatter = seen.scale.asDiagonal() *
                           (covarianceOf(changes) + openByOneBlock(byContrast)) *
                           seen.scale.asDiagonal();
    const Square whole = repeating + scatter +
                         covariance(seen.scatterOfPrior + kPixelNoise * kPixelNoise * byContrast.H);
    const double noise = std::max(std::pow(photometric.sigma, 2), kPixelNoise * kPixelNoise);
    const Minimum byArea = minimumOf(weightedByArea(image, noise), photometric, prior, errors);
    const Few unit = seen.scale.cwiseInverse();
    const Square disagreeing =
        seen.scale.asDiagonal() *
        disagreement(byContrast, byArea, changes, unit.asDiagonal() * whole * unit.asDiagonal()) *
        seen.scale.asDiagonal();
    if (!whole.allFinite()) return result;
    result.repeating += seen.V * (repeating + disagreeing) * seen.V.transpose();
    PoseEquations& equations = result.equations;
    equations.information = seen.toY.transpose() * (whole + disagreeing).ldlt().solve(seen.toY);
    equations.information =
        0.5 * (equations.information + equations.information.transpose()).eval();
    equations.rhs = equations.information * byContrast.x.head<6>();
    return result;
}

MeasuredInformation respondingBy(const Matrix6& M, const MeasuredInformation& image) {
    constexpr double kNoResponse = 1e-3;  // a response as small leaves a direction open
    const Matrix6 inverse = (M + kNoResponse * Matrix6::Identity()).inverse();
    MeasuredInformation result = image;
    result.equations.information = M.transpose() * image.equations.information * M;
    result.equations.rhs = M.transpose() * image.equations.rhs;
    result.repeating = inverse * image.repeating * inverse.transpose();
    return result;
}

Matrix6 smaller(const Matrix6& a, const Matrix6& b) {
    return combined(a, b, [](double variance) { return std::min(variance, 1.); });
}

Matrix6 larger(const Matrix6& a, const Matrix6& b) {
    return combined(a, b, [](double variance) { return std::max(variance, 1.); });
}

Matrix6 posteriorCovariance(const Matrix6& prior, const Matrix6& information,
                            const Matrix6& repeating) {
    const Matrix6 updated = updateCovariance(prior, information);
    if (repeating.isZero(0.)) return updated;
    constexpr double kNegligible = 1e-10;  // makes them definite [m^2], [rad^2]
    const Matrix6 negligible = kNegligible * Matrix6::Identity();
    const Matrix6 reached = smaller(prior, repeating + negligible) + 1e-3 * negligible;
    // The larger of two covariances below the prior need not be below it: images in a row would
    // make the belief wider and wider.
    return smaller(larger(updated, reached), prior + negligible);
}

}  // namespace photonav
