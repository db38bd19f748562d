// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/depth_calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "alignment/normal_equations.hpp"
#include "geometry/se3.hpp"
#include "photometry/opencv_image.hpp"

namespace photonav {
namespace {

using Matrix86 = Eigen::Matrix<double, 8, 6>;

constexpr double kBlurs[] = {4., 2., 1.};           // of the images, coarse to fine [pixels]
constexpr int kIterations = 6;                      // at each blur
constexpr std::size_t kBlocks = 16;                 // of pairs that are left out together, at most
constexpr int kRegionColumns = 4, kRegionRows = 3;  // of the depth image, likewise
constexpr std::size_t kRegions = kRegionColumns * kRegionRows;
constexpr int kReach = 5;               // of the differences that give normals [pixels]
constexpr double kBend = 1.5;           // KeyframeOptions::maxBend
constexpr double kGrazing = 0.2;        // least cosine between ray and normal
constexpr double kOutlier = 7.;         // medians of the absolute residuals
constexpr double kLeastOutlier = 0.01;  // [grey value]

struct Surfel {
    Eigen::Vector3f point, normal;  // depth camera's frame
    std::size_t region;             // of the depth image
};

/// Two images and the surfaces of the first.
struct Pair {
    cv::Mat first, second;
    std::vector<Surfel> surfels;
    Pose T_second_first;
    double gain = 1., offset = 0.;
};

/// A blurred image and its gradient.
struct Smooth {
    cv::Mat grey, gx, gy;

    Smooth(const cv::Mat& image, double blur) {
        cv::GaussianBlur(image, grey, {}, blur);
        cv::Sobel(grey, gx, CV_32F, 1, 0, 1, 0.5);
        cv::Sobel(grey, gy, CV_32F, 0, 1, 1, 0.5);
    }

    struct Sample {
        double grey;
        Eigen::RowVector2d gradient;
    };
    /// Between four pixels; nothing at the border and beyond.
    std::optional<Sample> at(const Eigen::Vector2d& pixel) const {
        const double u = pixel.x(), v = pixel.y();
        if (!(u >= 1. && v >= 1. && u < grey.cols - 2 && v < grey.rows - 2)) return {};
        const int x = static_cast<int>(u), y = static_cast<int>(v);
        const double a = u - x, b = v - y;
        const auto between = [&](const cv::Mat& m) {
            const float* above = m.ptr<float>(y) + x;
            const float* below = m.ptr<float>(y + 1) + x;
            return (1. - b) * ((1. - a) * above[0] + a * above[1]) +
                   b * ((1. - a) * below[0] + a * below[1]);
        };
        return Sample{between(grey), {between(gx), between(gy)}};
    }
};

/// Sums over the residuals of a part of a pair: about the depth camera's pose, and about the pair's
/// own motion and exposure (xi, gain, offset).
struct PartEquations {
    Matrix6 information = Matrix6::Zero();
    Vector6 right = Vector6::Zero();
    Matrix86 coupling = Matrix86::Zero();
    Vector8 ownRight = Vector8::Zero();

    PartEquations& operator+=(const PartEquations& other) {
        information += other.information;
        right += other.right;
        coupling += other.coupling;
        ownRight += other.ownRight;
        return *this;
    }
};

/// Normal equations of a cluster of residuals about the depth camera's pose; what belongs to
/// motions and exposures is eliminated.
struct Cluster {
    Matrix6 information = Matrix6::Zero();
    Vector6 right = Vector6::Zero();

    Cluster& operator+=(const Cluster& other) {
        information += other.information;
        right += other.right;
        return *this;
    }
};

/// Normal equations of one pair, by the regions of its depth image.
struct PairEquations {
    std::array<PartEquations, kRegions> parts;
    Matrix8 own = Matrix8::Zero();

    void add(std::size_t region, const Eigen::Matrix<double, 1, 6>& J,
             const Eigen::Matrix<double, 1, 8>& ofOwn, double r, double weight) {
        PartEquations& part = parts[region];
        part.information += weight * J.transpose() * J;
        part.right -= weight * r * J.transpose();
        part.coupling += weight * ofOwn.transpose() * J;
        part.ownRight -= weight * r * ofOwn.transpose();
        own += weight * ofOwn.transpose() * ofOwn;
    }

    PartEquations sum() const {
        PartEquations all;
        for (const PartEquations& part : parts) all += part;
        return all;
    }

    /// Motion and exposure that belong to a step of the depth camera.
    Vector8 ownStep(const Vector6& x) const {
        const PartEquations all = sum();
        return own.ldlt().solve(all.ownRight - all.coupling * x);
    }

    /// What each region contributes when motion and exposure follow the whole image.
    std::array<Cluster, kRegions> withoutOwn() const {
        const Matrix86 solved = own.ldlt().solve(sum().coupling);
        std::array<Cluster, kRegions> clusters;
        for (std::size_t i = 0; i < kRegions; ++i) {
            clusters[i].information = parts[i].information - solved.transpose() * parts[i].coupling;
            clusters[i].right = parts[i].right - solved.transpose() * parts[i].ownRight;
        }
        return clusters;
    }

    void regularise() { own.diagonal().array() += 1e-9 * own.trace() + 1e-12; }
};

/// Scatter of the step H^-1 b if clusters are left out one at a time (jackknife).
Matrix6 scatterOf(const std::vector<Cluster>& clusters, const Matrix6& inverse,
                  const Vector6& step) {
    Matrix6 scatter = Matrix6::Zero();
    for (const Cluster& cluster : clusters) {
        const Vector6 without = (Matrix6::Identity() - cluster.information * inverse)
                                    .partialPivLu()
                                    .solve(cluster.right - cluster.information * step);
        scatter += without * without.transpose();
    }
    // The inverse of a covariance of few draws is too large (residual_covariance.cpp).
    const auto count = static_cast<double>(clusters.size());
    return count / std::max(1., count - 7.) * inverse * scatter * inverse.transpose();
}

/// Motion of a point by a twist.
Eigen::Matrix<double, 3, 6> byTwist(const Eigen::Vector3d& p) {
    Eigen::Matrix<double, 3, 6> motion;
    motion.leftCols<3>().setIdentity();
    motion.rightCols<3>() = -hat(p);
    return motion;
}

double medianOf(std::vector<float>& values) {
    if (values.empty()) return 0.;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

class DepthCalibrator::Problem {
  public:
    Problem(const Camera& colour, const DepthCamera& start, const DepthCalibrationOptions& options)
        : colour_(colour), depth_(start), options_(options) {}

    void add(const ImageF& first, const ImageF& depth_d, const ImageF& second,
             const Pose& T_second_first);
    std::size_t pairs() const { return pairs_.size(); }
    DepthCalibration solve();

  private:
    std::optional<Surfel> surfelAt(const ImageF& depth_d, unsigned u, unsigned v) const;
    PairEquations equationsOf(const Pair& pair, const Pose& T_c_d, double blur,
                              std::vector<float>& residuals) const;
    void descend(bool movesDepthCamera, DepthCalibration& result);
    void step(bool movesDepthCamera, double blur, DepthCalibration& result);
    Matrix6 informationOf(const std::vector<PairEquations>& pairs, Vector6& step) const;

    Camera colour_;
    DepthCamera depth_;
    DepthCalibrationOptions options_;
    std::vector<Pair> pairs_;
    double outlier_ = 0.;  ///< residual that counts a quarter [grey value]
};

/// The point of a pixel and the normal there, where the surface is smooth.
std::optional<Surfel> DepthCalibrator::Problem::surfelAt(const ImageF& depth_d, unsigned u,
                                                         unsigned v) const {
    const float z = depth_d[v][u], left = depth_d[v][u - kReach], right = depth_d[v][u + kReach];
    const float above = depth_d[v - kReach][u], below = depth_d[v + kReach][u];
    if (!(z >= options_.minDepth && z <= options_.maxDepth)) return {};
    if (!(std::min({left, right, above, below}) > 0.F)) return {};
    const Camera& camera = depth_.camera;
    const double alongRow = z / left + z / right - 2., alongColumn = z / above + z / below - 2.;
    if (std::abs(alongRow) > kBend * kReach / camera.fx()) return {};
    if (std::abs(alongColumn) > kBend * kReach / camera.fy()) return {};
    const Eigen::Vector3d across =
        camera.unproject(u + kReach, v, right) - camera.unproject(u - kReach, v, left);
    const Eigen::Vector3d down =
        camera.unproject(u, v + kReach, below) - camera.unproject(u, v - kReach, above);
    const Eigen::Vector3d point = camera.unproject(u, v, z);
    const Eigen::Vector3d normal = across.cross(down).normalized();
    if (!(std::abs(normal.dot(point)) > kGrazing * point.norm())) return {};
    const std::size_t region = v * kRegionRows / depth_d.getHeight() * kRegionColumns +
                               u * kRegionColumns / depth_d.getWidth();
    return Surfel{point.cast<float>(), normal.cast<float>(), region};
}

void DepthCalibrator::Problem::add(const ImageF& first, const ImageF& depth_d, const ImageF& second,
                                   const Pose& T_second_first) {
    const auto fits = [](const ImageF& image, const Camera& camera) {
        return image.getWidth() == camera.width && image.getHeight() == camera.height;
    };
    if (!fits(first, colour_) || !fits(second, colour_) || !fits(depth_d, depth_.camera)) {
        throw std::invalid_argument("depth calibration: image and camera differ in size");
    }
    Pair pair{asMat(first).clone(), asMat(second).clone(), {}, T_second_first};
    const auto stride = static_cast<unsigned>(options_.stride);
    for (unsigned v = kReach; v + kReach < depth_d.getHeight(); v += stride) {
        for (unsigned u = kReach; u + kReach < depth_d.getWidth(); u += stride) {
            if (const auto surfel = surfelAt(depth_d, u, v)) pair.surfels.push_back(*surfel);
        }
    }
    pairs_.push_back(std::move(pair));
}

PairEquations DepthCalibrator::Problem::equationsOf(const Pair& pair, const Pose& T_c_d,
                                                    double blur,
                                                    std::vector<float>& residuals) const {
    const Smooth first(pair.first, blur), second(pair.second, blur);
    const Eigen::Matrix3d R = pair.T_second_first.linear();
    PairEquations equations;
    for (const Surfel& surfel : pair.surfels) {
        const Eigen::Vector3d p = T_c_d * surfel.point.cast<double>();
        const Eigen::Vector3d q = pair.T_second_first * p;
        if (!(p.z() > 0.1 && q.z() > 0.1)) continue;
        const auto before = first.at(colour_.project(p)), after = second.at(colour_.project(q));
        if (!before || !after) continue;
        // The mean gradient of both images, by the motion of a surface parallel to them.
        const Eigen::Matrix<double, 2, 3> ofFirst = colour_.projectionJacobian(p);
        const Eigen::Matrix<double, 2, 3> ofSecond = colour_.projectionJacobian(q) * R;
        const Eigen::Matrix2d warp =
            ofSecond * ofFirst.transpose() * (ofFirst * ofFirst.transpose()).inverse();
        const Eigen::RowVector2d gradient =
            0.5 * (pair.gain * before->gradient * warp.inverse() + after->gradient);
        const Eigen::RowVector3d byPoint = gradient * ofSecond;  // per motion of p
        const Eigen::RowVector3d n = (T_c_d.linear() * surfel.normal.cast<double>()).transpose();
        const Eigen::RowVector3d byNormal = byPoint.dot(p.transpose()) / n.dot(p.transpose()) * n;
        const Eigen::RowVector3d byMotion = byPoint * R.transpose();
        const Eigen::Matrix<double, 1, 6> J = byNormal * byTwist(p);
        Eigen::Matrix<double, 1, 8> ofOwn;
        ofOwn.head<6>() = byMotion * byTwist(q);
        ofOwn[6] = -before->grey;
        ofOwn[7] = -1.;
        const double r = after->grey - (pair.gain * before->grey + pair.offset);
        residuals.push_back(static_cast<float>(std::abs(r)));
        const double root = 1. / (1. + r * r / (outlier_ * outlier_));  // Geman and McClure
        equations.add(surfel.region, J, ofOwn, r, root * root);
    }
    equations.regularise();
    return equations;
}

/// The information of all pairs, and the step that they ask for. Two kinds of errors scatter:
/// those of what is in view, which neighbouring pairs share, and those of the cameras' intrinsics
/// and distortion, which a region of the image has in all pairs. Blocks of pairs are left out for
/// the ones and regions for the others, and the covariances are added.
Matrix6 DepthCalibrator::Problem::informationOf(const std::vector<PairEquations>& pairs,
                                                Vector6& step) const {
    std::vector<Cluster> blocks(std::min(kBlocks, pairs.size())), regions(kRegions);
    Cluster sum;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto parts = pairs[i].withoutOwn();
        for (std::size_t k = 0; k < kRegions; ++k) {
            blocks[i * blocks.size() / pairs.size()] += parts[k];
            regions[k] += parts[k];
            sum += parts[k];
        }
    }
    sum.information += 1e-9 * sum.information.trace() * Matrix6::Identity();
    const Matrix6 inverse = sum.information.inverse();
    step = inverse * sum.right;
    const Matrix6 covariance = scatterOf(blocks, inverse, step) + scatterOf(regions, inverse, step);
    return (covariance + 1e-12 * Matrix6::Identity()).inverse();
}

void DepthCalibrator::Problem::step(bool movesDepthCamera, double blur, DepthCalibration& result) {
    std::vector<PairEquations> equations;
    std::vector<float> residuals;
    for (const Pair& pair : pairs_) {
        equations.push_back(equationsOf(pair, result.T_c_d, blur, residuals));
    }
    Vector6 x = Vector6::Zero();
    if (movesDepthCamera) {
        const Matrix6 information = informationOf(equations, x);
        Vector6 prior;
        prior << Eigen::Vector3d::Constant(options_.translationSigma),
            Eigen::Vector3d::Constant(options_.rotationSigma);
        const Vector6 weight = prior.cwiseAbs2().cwiseInverse();
        const Vector6 away = logSE3(result.T_c_d * depth_.T_c_d.inverse());
        const Matrix6 both = information + Matrix6(weight.asDiagonal());
        x = both.ldlt().solve(information * x - weight.cwiseProduct(away));
        result.covariance = both.inverse();
    }
    result.T_c_d = expSE3(x) * result.T_c_d;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        const Vector8 own = equations[i].ownStep(x);
        pairs_[i].T_second_first = expSE3(own.head<6>()) * pairs_[i].T_second_first;
        pairs_[i].gain += own[6];
        pairs_[i].offset += own[7];
    }
    result.residualAfter = medianOf(residuals);
    outlier_ = std::max(kLeastOutlier, kOutlier * result.residualAfter);
}

void DepthCalibrator::Problem::descend(bool movesDepthCamera, DepthCalibration& result) {
    outlier_ = 0.05;  // before there are residuals
    for (const double blur : kBlurs) {
        for (int i = 0; i < kIterations; ++i) step(movesDepthCamera, blur, result);
    }
}

DepthCalibration DepthCalibrator::Problem::solve() {
    if (pairs_.size() < kLeastPairs) throw std::invalid_argument("depth calibration: few pairs");
    DepthCalibration result;
    result.T_c_d = depth_.T_c_d;
    descend(false, result);
    result.residualBefore = result.residualAfter;
    descend(true, result);
    return result;
}

DepthCalibrator::DepthCalibrator(const Camera& colour, const DepthCamera& start,
                                 const DepthCalibrationOptions& options)
    : problem_(std::make_unique<Problem>(colour, start, options)) {}
DepthCalibrator::~DepthCalibrator() = default;
DepthCalibrator::DepthCalibrator(DepthCalibrator&&) noexcept = default;
DepthCalibrator& DepthCalibrator::operator=(DepthCalibrator&&) noexcept = default;

void DepthCalibrator::add(const ImageF& first, const ImageF& depth_d, const ImageF& second,
                          const Pose& T_second_first) {
    problem_->add(first, depth_d, second, T_second_first);
}

std::size_t DepthCalibrator::pairs() const { return problem_->pairs(); }

DepthCalibration DepthCalibrator::solve() { return problem_->solve(); }

}  // namespace photonav
