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

/// Outcome of an alignment.
enum class Verdict {
    converged,
    degenerate,       ///< converged, but the image does not determine all directions
    lostOverlap,      ///< too little of the model in view
    lostResidual,     ///< predicted and observed image differ too much
    lostTexture,      ///< most of the predicted texture is not where it was predicted
    lostDivergence,   ///< no minimum found
    lostImplausible,  ///< the pose is too far from the prior
    lostExposure,     ///< the fit needs an implausible gain
};

/// Whether an alignment gives no pose: any verdict but converged and degenerate.
inline bool isLost(Verdict verdict) {
    return verdict != Verdict::converged && verdict != Verdict::degenerate;
}

/// Prior of an image's gain and offset if they are estimated: standard deviations of their
/// differences from 1 and 0. Without a prior, a change of gain and offset could fit a half blank
/// image as well as a change of the pose.
struct ExposurePrior {
    double gainSigma = kInfinity;
    double offsetSigma = kInfinity;  ///< [grey value]

    /// Inverse variances of gain and offset.
    Eigen::Vector2d information() const {
        return {1. / (gainSigma * gainSigma), 1. / (offsetSigma * offsetSigma)};
    }
    /// Difference of an exposure from the prior's mean: (gain - 1, offset).
    static Eigen::Vector2d difference(const Exposure& exposure) {
        return {exposure.gain - 1., exposure.offset};
    }
    /// Squared Mahalanobis distance of an exposure from the prior's mean.
    double squaredDistance(const Exposure& exposure) const {
        return information().dot(difference(exposure).cwiseAbs2());
    }
};

/// Conditions on which an alignment is accepted, and least standard deviations of its result.
struct TrustOptions {
    double minOverlap = 0.2;  ///< least share of the image's pixels that must be used
    /// Largest share of the images' variance that may be left unexplained if the RMS residual
    /// exceeds `residualSigmas` times the image noise: E[r^2] / (var(observed) + var(predicted)), 0
    /// for equal images, 1 for uncorrelated ones. Texture finer than the model's cells is not
    /// counted.
    double maxUnexplained = 0.4;
    double residualSigmas = 3.;  ///< see maxUnexplained [standard deviations of the image noise]
    /// Least share of the predicted texture that the image must show (SharedTexture), if the model
    /// can be rendered and the covariance is measured: lost if it is below by two standard
    /// deviations.
    double minTexture = 0.5;
    /// A direction is open if its standard deviation by the image alone is larger than this [rad;
    /// translations in units of the mean depth].
    double openSigma = 0.02;
    /// Largest squared Mahalanobis distance of the pose from its prior (6 degrees of freedom).
    double maxPriorDistance = 60.;
    /// Estimated gains are limited to [1 / maxGain, maxGain]: with a very large gain, a nearly
    /// uniform image would fit any other.
    double maxGain = 3.;
    /// Least standard deviations of the result. Errors that repeat from image to image, such as
    /// errors of the map, do not average out over the pixels.
    double leastSigma = 0.;          ///< [m]
    double leastSigmaRotation = 0.;  ///< [rad]
};

/// Statistics of the residuals observed - (gain * predicted + offset) over the pixels used, grey
/// values.
struct ResidualStatistics {
    double mean = 0.;
    double rms = 0.;
    double robustSigma = 0.;  ///< 1.4826 times the median of the absolute values
    double unexplained = 0.;  ///< share of the variance, see TrustOptions::maxUnexplained
    double explained = 0.;    ///< variance of the observed image minus the mean square residual
    /// Mean square of the image content that is finer than the model's cells, noise included. No
    /// pose explains it. 0 for a mesh, and if the residuals are within the image noise.
    double finer = 0.;
    std::optional<SharedTexture> texture;  ///< none: not measured

    /// `unexplained` without the content that is finer than the model's cells.
    double unexplainedCoarse() const {
        const double square = rms * rms;
        return square > finer ? unexplained * (square - finer) / (square - unexplained * finer)
                              : 0.;
    }
};

/// Whether the image contradicts most of the predicted texture (TrustOptions::minTexture).
inline bool isTextureElsewhere(const ResidualStatistics& residual, const TrustOptions& trust) {
    return residual.texture && residual.texture->isBelow(trust.minTexture);
}

/// Names of the components of the camera's twist: translations along x, y, z of the camera frame,
/// then rotations about x, y, z.
inline constexpr std::array kTwistAxes = {"x", "y", "z", "pitch", "yaw", "roll"};

/// Result of an alignment.
struct Alignment {
    /// Pose of the camera in the model; the last iterate if the alignment is lost.
    Pose T_c_w = Pose::Identity();
    /// Covariance of the left perturbation (rho, phi), camera frame. Without a prior, open
    /// directions have standard deviations of at most one mean depth or one radian.
    Matrix6 covariance = Matrix6::Zero();
    /// Information of the image alone, same frame: Lambda, or measuredInformation() if
    /// AlignmentOptions::measureCovariance is set. Corrected as AlignmentOptions::measureSlope
    /// says.
    Matrix6 information = Matrix6::Zero();
    Exposure exposure;
    int iterations = 0;  ///< number of views compared, over all levels
    ResidualStatistics residual;
    double overlap = 0.;  ///< share of the image's pixels that were used
    /// Variance of the image's point spread less the model views' variance, by the residuals, and
    /// its standard deviation by their noise; infinite: not estimated (keyframes) [pixels^2].
    double blur = 0., blurSigma = kInfinity;
    /// Eigenvalues of `information` with translations in units of the mean depth [1/rad^2],
    /// ascending.
    Vector6 eigenvalues = Vector6::Zero();
    /// Columns: unit eigenvectors (rho / depth, phi) of `eigenvalues`.
    Matrix6 directions = Matrix6::Identity();
    double meanDepth = 1.;  ///< harmonic mean over the view [m]
    Verdict verdict = Verdict::lostDivergence;
    /// Names from kTwistAxes, one per open direction: the axes closest to the space of open
    /// directions.
    std::vector<std::string> openDirections;
};

/// Whether all directions are open: the image determines no component of the pose.
inline bool isUninformative(const Alignment& alignment) {
    return alignment.openDirections.size() == kTwistAxes.size();
}

/// The verdict in words: "converged", "degenerate along x, yaw", "lost: overlap 0.12 below 0.20".
std::string describe(const Alignment& alignment, const TrustOptions& options = {});

/// Largest standard deviation of gain and offset that is used as their prior in one step. It keeps
/// the equations of uniform images solvable.
inline constexpr double kExposureSigma = 0.3;

/// Normal equations of the camera pose alone, with the exposure eliminated: Fisher information and
/// right side b = A^T r / sigma^2 with A = -gain J (NormalEquations). The step by the image alone
/// solves information * xi = b.
struct PoseEquations {
    Matrix6 information = Matrix6::Zero();
    Vector6 rhs = Vector6::Zero();
    /// (d gain, d offset) = exposureRhs - exposureOfPose * xi; zero with a fixed exposure.
    Eigen::Vector2d exposureRhs = Eigen::Vector2d::Zero();
    Eigen::Matrix<double, 2, 6> exposureOfPose = Eigen::Matrix<double, 2, 6>::Zero();
};
/// Eliminates the exposure from normal equations.
/// @param prior of the exposure; none: the exposure is fixed
/// @param exposure the iterate at which `equations` were computed
PoseEquations poseEquations(const NormalEquations& equations, const PhotometricOptions& options,
                            const std::optional<ExposurePrior>& prior = {},
                            const Exposure& exposure = {});

/// Eigenvalues and eigenvectors of an information matrix whose translations are in units of the
/// mean depth.
struct Spectrum {
    Vector6 values;      ///< eigenvalues, ascending
    Matrix6 directions;  ///< columns: unit eigenvectors (rho / depth, phi)
    Vector6 unit;        ///< units of the components: (depth, depth, depth, 1, 1, 1)
};
/// @param meanDepth mean depth of the view [m]
Spectrum spectrum(const Matrix6& information, double meanDepth);

/// Step by the image alone, in the directions with eigenvalues above `minEigenvalue`. Each
/// eigenvalue is raised by `damping` times the mean eigenvalue.
Vector6 imageStep(const Spectrum& spectrum, const Vector6& right, double minEigenvalue,
                  double damping);

/// Step toward the most likely pose given the image and the prior. It solves
///     (Lambda + damping + P^-1) xi = b - P^-1 e   as   (1 + P (Lambda + damping)) xi = P b - e,
/// which holds for a singular P as well.
/// @param e deviation() of the iterate from the prior's mean
/// @param P covariance of the prior, transported() by e
Vector6 posteriorStep(const Spectrum& spectrum, const PoseEquations& equations, const Vector6& e,
                      const Matrix6& P, double damping);

/// Raises a covariance in the directions in which it is below the least standard deviations
/// (eigenvalues relative to their squares are raised to 1).
/// @param translation least standard deviation [m]; 0: none
/// @param rotation least standard deviation [rad]; 0: none
Matrix6 withLeastSigma(const Matrix6& covariance, double translation, double rotation);

/// Squared Mahalanobis distance e^T covariance^-1 e. The covariance may be singular: variances of
/// the translation are raised by a millionth of the largest of them, those of the rotation as well.
double squaredDistance(const Vector6& e, const Matrix6& covariance);

}  // namespace photonav
