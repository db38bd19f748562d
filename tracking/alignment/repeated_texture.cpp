// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/repeated_texture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/se3.hpp"

namespace photonav {
namespace {

constexpr int kParts = 4;       // of a view's width, and of its height as many as are about square
constexpr int kFarthest = 16;   // coarse levels tell texture of longer periods apart [pixels]
constexpr double kWithin = 3.;  // standard deviations of the prior
constexpr double kDip = 0.5;    // most of the hill that is left behind it
constexpr double kLeastHill = 12.;  // -2 log likelihood
constexpr double kSame = 1.;        // of two twists that move all parts alike [pixels]
constexpr double kNoMotion = 1e-6;  // makes covariances definite [pixels^2]

/// A rectangle of a view, and how its middle moves when the camera does.
struct Part {
    Eigen::Array2i begin, end;      ///< (u, v) [pixels]
    Eigen::Matrix<double, 2, 6> J;  ///< pixels by the twist
    Eigen::Vector2d mean;           ///< motion to the prior's mean [pixels]
    Eigen::Matrix2d covariance;     ///< of the motion [pixels^2]
    Eigen::Matrix2d information;

    int pixels() const { return (end - begin).prod(); }
    /// Squared Mahalanobis distance of a motion from the prior's mean.
    double squaredDistance(int u, int v) const {
        const Eigen::Vector2d d = Eigen::Vector2d(u, v) - mean;
        return d.dot(information * d);
    }
    /// Pixels within which motions are plausible.
    int reach() const {
        const Eigen::Array2d most =
            mean.array().abs() + kWithin * covariance.diagonal().array().sqrt();
        return static_cast<int>(std::min<double>(most.maxCoeff(), kFarthest));
    }
};

/// Harmonic mean [m]; 0: no surface.
double meanDepthOf(const View& view, const Part& part) {
    double inverse = 0.;
    int count = 0;
    for (int v = part.begin.y(); v < part.end.y(); ++v) {
        for (int u = part.begin.x(); u < part.end.x(); ++u) {
            if (view.depth[v][u] <= 0.F) continue;
            inverse += 1. / view.depth[v][u];
            ++count;
        }
    }
    return count > 0 ? count / inverse : 0.;
}

/// How a point moves in the image by a twist of the camera.
Eigen::Matrix<double, 2, 6> motionOf(const Eigen::Vector3d& p, const Camera& camera) {
    Eigen::Matrix<double, 3, 6> ofPoint;
    ofPoint << Eigen::Matrix3d::Identity(), -hat(p);
    return camera.projectionJacobian(p) * ofPoint;
}

/// @param toMean twist to the prior's mean
std::vector<Part> partsOf(const View& view, const Camera& camera, const Vector6& toMean,
                          const Matrix6& P) {
    const Eigen::Array2i size(camera.width, camera.height);
    const Eigen::Array2i count(kParts, std::max(1, (kParts * size.y() + size.x() / 2) / size.x()));
    std::vector<Part> parts;
    for (int j = 0; j < count.y(); ++j) {
        for (int i = 0; i < count.x(); ++i) {
            const Eigen::Array2i index(i, j);
            Part part;
            part.begin = index * size / count;
            part.end = (index + 1) * size / count;
            const double depth = meanDepthOf(view, part);
            if (depth <= 0.) continue;
            const Eigen::Array2d middle = 0.5 * (part.begin + part.end - 1).cast<double>();
            part.J = motionOf(depth * camera.unproject(middle.x(), middle.y()), camera);
            part.mean = part.J * toMean;
            part.covariance =
                part.J * P * part.J.transpose() + kNoMotion * Eigen::Matrix2d::Identity();
            part.information = part.covariance.inverse();
            parts.push_back(part);
        }
    }
    return parts;
}

/// Mean square differences of a part of an image from the image displaced.
class SelfDifferences {
  public:
    /// @param weight of a sum of squares over pixels, see repetitions()
    SelfDifferences(const ImageF& image, const Part& part, int reach, double weight)
        : image_(image),
          part_(part),
          weight_(weight),
          reach_(reach + 1),
          known_(Eigen::ArrayXXd::Constant(2 * reach_ + 1, 2 * reach_ + 1, -1.)) {}

    double at(int u, int v) {
        double& known = known_(u + reach_, v + reach_);
        if (known < 0.) known = difference(u, v);
        return known;
    }
    /// Of what is left of the part and the prior: along bars all motions look the same.
    bool isMinimum(int u, int v) {
        for (int j = -1; j <= 1; ++j) {
            for (int i = -1; i <= 1; ++i) {
                if ((i != 0 || j != 0) && cost(u + i, v + j) <= cost(u, v)) return false;
            }
        }
        return true;
    }
    /// The highest on the way to (u, v).
    double hillBefore(int u, int v) {
        double most = 0.;
        const int steps = std::max(std::abs(u), std::abs(v));
        for (int k = 1; k < steps; ++k) {
            const double share = static_cast<double>(k) / steps;
            most = std::max(most, at(static_cast<int>(std::lround(share * u)),
                                     static_cast<int>(std::lround(share * v))));
        }
        return most;
    }

  private:
    /// -2 log likelihood.
    double cost(int u, int v) {
        return weight_ * part_.pixels() * at(u, v) + part_.squaredDistance(u, v);
    }
    double difference(int u, int v) const {
        const Eigen::Array2i size(image_.getWidth(), image_.getHeight());
        const Eigen::Array2i d(u, v);
        const Eigen::Array2i begin = part_.begin.max(-d), end = part_.end.min(size - d);
        const Eigen::Array2i count = end - begin;
        if ((count <= 0).any() || 2 * count.prod() < part_.pixels()) {
            return std::numeric_limits<double>::max();
        }
        double sum = 0.;
        int rows = 0;
        for (int row = begin.y(); row < end.y(); row += 2, ++rows) {  // half of them are enough
            const Eigen::Map<const Eigen::ArrayXf> a(image_[row] + begin.x(), count.x());
            const Eigen::Map<const Eigen::ArrayXf> b(image_[row + v] + begin.x() + u, count.x());
            sum += static_cast<double>((a - b).square().sum());
        }
        return sum / (rows * count.x());
    }

    const ImageF& image_;
    const Part& part_;
    double weight_;
    int reach_;
    Eigen::ArrayXXd known_;  // negative: not yet
};

/// Motions of a part after which it looks as before [pixels].
std::vector<Eigen::Vector2d> repetitionsOf(const ImageF& image, const Part& part, double weight) {
    const int reach = part.reach();
    std::vector<Eigen::Vector2d> found;
    SelfDifferences differences(image, part, reach, weight);
    for (int v = -reach; v <= reach; ++v) {
        for (int u = -reach; u <= reach; ++u) {
            if (part.squaredDistance(u, v) > kWithin * kWithin || !differences.isMinimum(u, v))
                continue;
            const double hill = differences.hillBefore(u, v);
            const bool isHill = weight * part.pixels() * hill > kLeastHill;
            if (isHill && differences.at(u, v) < kDip * hill) found.emplace_back(u, v);
        }
    }
    return found;
}

}  // namespace

std::vector<Vector6> repetitions(const View& predicted, const Pose& T_c_w,
                                 const UncertainPose& prior, const Camera& camera, double weight) {
    const Matrix6 P = transported(prior.covariance, deviation(T_c_w, prior.mean));
    const std::vector<Part> parts = partsOf(predicted, camera, deviation(prior.mean, T_c_w), P);
    std::vector<Vector6> twists;
    const auto isKnown = [&](const Vector6& xi) {
        return std::any_of(twists.begin(), twists.end(), [&](const Vector6& other) {
            return std::all_of(parts.begin(), parts.end(), [&](const Part& part) {
                return (part.J * (xi - other)).norm() < kSame;
            });
        });
    };
    for (const Part& part : parts) {
        if (part.reach() < 2) continue;
        for (const Eigen::Vector2d& d : repetitionsOf(predicted.intensity, part, weight)) {
            const Vector6 xi = P * part.J.transpose() * part.information * d;
            if (!isKnown(xi)) twists.push_back(xi);
        }
    }
    return twists;
}

}  // namespace photonav
