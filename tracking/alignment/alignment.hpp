// SPDX-License-Identifier: BSD-3-Clause
// The result of an alignment: pose, covariance and verdict.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "alignment/normal_equations.hpp"
#include "geometry/constants.hpp"
#include "geometry/uncertain_pose.hpp"

namespace photonav {

enum class Verdict {
    converged,
    degenerate,       ///< converged, but the image does not determine all directions
    lostOverlap,      ///< too little of the model in view
    lostResidual,     ///< the predicted image differs too much
    lostDivergence,   ///< no minimum found
    lostImplausible,  ///< too far from the prior
    lostExposure,     ///< the fit needs an implausible gain or offset
};

inline bool isLost(Verdict verdict) {
    return verdict != Verdict::converged && verdict != Verdict::degenerate;
}

/// Prior of an image's gain and offset, where they are estimated: standard deviations of their
/// differences from 1 and 0. Without a prior, gain and offset could explain the motion of a half
/// blank image instead of the pose.
struct ExposurePrior {
    double gainSigma = kInfinity;
    double offsetSigma = kInfinity;  ///< [grey value]

    /// Inverse variances.
    Eigen::Vector2d information() const {
        return {1. / (gainSigma * gainSigma), 1. / (offsetSigma * offsetSigma)};
    }
    /// (gain - 1, offset).
    static Eigen::Vector2d difference(const Exposure& exposure) {
        return {exposure.gain - 1., exposure.offset};
    }
    /// Squared Mahalanobis distance.
    double squaredDistance(const Exposure& exposure) const {
        return information().dot(difference(exposure).cwiseAbs2());
    }
};

/// When an alignment is accepted, and its noise.
struct TrustOptions {
    double minOverlap = 0.2;  ///< least share of the image's pixels that must count
    /// A residual above `residualSigmas` times the image noise must leave less than this share of
    /// the images' variance unexplained: var(r) / (var(observed) + var(predicted)), 0 for equal
    /// images, 1 for images that have nothing to do with each other. What is finer than the model's
    /// cells is left out.
    double maxUnexplained = 0.4;
    double residualSigmas = 3.;
    /// A direction is open when the image alone leaves it with a larger standard deviation [rad;
    /// translations in units of the mean depth].
    double openSigma = 0.02;
    /// Largest squared Mahalanobis distance of the pose from its prior (6 degrees of freedom).
    double maxPriorDistance = 60.;
    /// Estimated gains are limited to [1 / maxGain, maxGain]: with a very large gain, a nearly
    /// uniform image would fit any other.
    double maxGain = 3.;
    /// Least standard deviations of the result. Errors that repeat from image to image, as those of
    /// the map, do not average out over the pixels.
    double leastSigma = 0.;          ///< [m]
    double leastSigmaRotation = 0.;  ///< [rad]
};

/// Residuals observed - (gain * predicted + offset), grey values, over the pixels that count.
struct ResidualStatistics {
    double mean = 0.;
    double rms = 0.;
    double robustSigma = 0.;  ///< 1.4826 times the median of the absolute value
    double unexplained = 0.;  ///< share of the variance, see TrustOptions
    double explained = 0.;    ///< variance of the observed image less the mean square residual
    /// Mean square of what the image shows finer than the model's cells, noise included: no pose
    /// explains it. 0 for a mesh, and where the residuals are noise.
    double finer = 0.;

    /// `unexplained` of what is not finer.
    double unexplainedCoarse() const {
        const double square = rms * rms;
        return square > finer ? unexplained * (square - finer) / (square - unexplained * finer)
                              : 0.;
    }
};

/// Names of the axes of a twist of the camera: translations, then rotations about x, y, z.
inline constexpr std::array kAxes = {"x", "y", "z", "pitch", "yaw", "roll"};

struct Alignment {
    /// Pose of the camera in the model; the last iterate when lost.
    Pose T_c_w = Pose::Identity();
    /// Left perturbation, camera frame, (rho, phi). Open directions without a prior get one mean
    /// depth and one radian of standard deviation.
    Matrix6 covariance = Matrix6::Zero();
    /// Information of the image alone, same frame: Lambda, or by measuredInformation(); where a
    /// model can be rendered, corrected by measuredSlope().
    Matrix6 information = Matrix6::Zero();
    Exposure exposure;
    int iterations = 0;  ///< views compared, over all levels
    ResidualStatistics residual;
    double overlap = 0.;  ///< share of the image's pixels that count
    /// Eigenvalues of Lambda with translations in units of the mean depth [1/rad^2], ascending;
    /// columns of `directions` are the unit eigenvectors, (rho / depth, phi).
    Vector6 eigenvalues = Vector6::Zero();
    Matrix6 directions = Matrix6::Identity();
    double meanDepth = 1.;  ///< harmonic mean over the view [m]
    Verdict verdict = Verdict::lostDivergence;
    /// Names from kAxes, one per open direction: the axes closest to the space of open directions.
    std::vector<std::string> openDirections;
};

/// Whether the image alone leaves all directions open.
inline bool isUninformative(const Alignment& alignment) {
    return alignment.openDirections.size() == kAxes.size();
}

/// The verdict in words: "converged", "degenerate along x, yaw", "lost: overlap 0.12 below 0.20".
std::string describe(const Alignment& alignment, const TrustOptions& options = {});

/// Largest standard deviation of a step of the exposure, which keeps uniform images solvable.
inline constexpr double kExposureSigma = 0.3;

/// Fisher information of the camera pose and its right side b = J^T r / sigma^2, exposure
/// eliminated: the step from the image alone solves information * xi = b.
struct PoseEquations {
    Matrix6 information = Matrix6::Zero();
    Vector6 right = Vector6::Zero();
    /// (d gain, d offset) = exposureRight - exposureOfPose * xi; zero with a fixed exposure.
    Eigen::Vector2d exposureRight = Eigen::Vector2d::Zero();
    Eigen::Matrix<double, 2, 6> exposureOfPose = Eigen::Matrix<double, 2, 6>::Zero();
};
/// @param prior of the exposure; none: the exposure is fixed
/// @param exposure at which the equations are
PoseEquations poseEquations(const NormalEquations& equations, const PhotometricOptions& options,
                            const std::optional<ExposurePrior>& prior = {},
                            const Exposure& exposure = {});

/// Eigenvalues of `information` with translations in units of `meanDepth`, ascending.
struct Spectrum {
    Vector6 values;
    Matrix6 directions;
    Vector6 unit;  ///< (meanDepth x 3, 1 x 3)
};
Spectrum spectrum(const Matrix6& information, double meanDepth);

/// Step by the image alone, confined to eigenvalues above `minEigenvalue`, each raised by `damping`
/// times their mean.
Vector6 imageStep(const Spectrum& spectrum, const Vector6& right, double minEigenvalue,
                  double damping);

/// Step toward the most likely pose given the image and the prior. It solves
/// (Lambda + damping + P^-1) xi = b - P^-1 e as (1 + P (Lambda + damping)) xi = P b - e, which
/// holds for a singular P as well.
/// @param e deviation(T, T_prior)
/// @param P covariance of the prior, transported() by e
Vector6 posteriorStep(const Spectrum& spectrum, const PoseEquations& equations, const Vector6& e,
                      const Matrix6& P, double damping);

/// The covariance, raised along the axes where it is below the least standard deviations
/// (eigenvalues relative to their squares, clipped at 1). 0: no least one.
/// @param translation least standard deviation [m]
/// @param rotation least standard deviation [rad]
Matrix6 withLeastSigma(const Matrix6& covariance, double translation, double rotation);

/// Squared Mahalanobis distance e^T covariance^-1 e; variances of zero are replaced by a millionth
/// of the largest.
double squaredDistance(const Vector6& e, const Matrix6& covariance);

}  // namespace photonav
