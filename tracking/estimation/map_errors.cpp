// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/map_errors.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "alignment/residual_covariance.hpp"
#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "map/map_change.hpp"
#include "photometry/photometric.hpp"

namespace photonav {
namespace {

constexpr unsigned kStride = 3;          // of the pixels looked at
constexpr std::size_t kMostMakers = 12;  // keyframes remembered of a brick: the first ones
// Of a surface on the border of two bricks: 0.02 cells [bricks].
constexpr double kBeside = 0.02 / MapChange::kBrickEdge;
constexpr double kWeakSigma = 0.005;  // standard deviation of an image alone that is too much
                                      // [rad], translations in mean depths
constexpr double kWeakInformation = 1. / (kWeakSigma * kWeakSigma);
constexpr double kNegligible = 1e-6;  // share of the mean information
// The pose in the map is never known better than to 1 % of the standard deviation in the world:
// errors are not exactly linear.
constexpr double kLeastRelative = 1e-4;

/// Unlike an alignment, a map is displaced at its edges and where it is saturated as well.
constexpr PhotometricOptions kEveryPixel{.depthJump = kInfinity, .saturation = -1.};

/// A brick, by its index along each axis.
std::uint64_t keyOf(const Eigen::Array3i& brick) {
    std::uint64_t key = 0;
    for (const int index : brick) {
        key = key << 21U | (static_cast<std::uint64_t>(index + (1 << 20)) & 0x1fffffU);
    }
    return key;
}

using Matrix12 = Eigen::Matrix<double, 12, 12>;

Matrix6 symmetric(const Matrix6& A) { return 0.5 * (A + A.transpose()); }

/// Covariances that are computed in different ways may together be a little indefinite.
Matrix12 nonNegative(const Matrix12& A) {
    const Eigen::SelfAdjointEigenSolver<Matrix12> solver(A);
    return solver.eigenvectors() * solver.eigenvalues().cwiseMax(1e-14).asDiagonal() *
           solver.eigenvectors().transpose();
}

}  // namespace

/// The keyframes that the surfaces in a view were made of, and their shares in its information.
struct MapErrors::Shares {
    struct Share {
        int keyframe;
        Matrix6 information = Matrix6::Zero();
        double pixels = 0.;
    };
    std::vector<Share> of;
    double pixels = 0.;
    double inverseDepth = 0.;  // sum [1/m]
};

MapErrors::MapErrors(double resolution) : brick_(MapChange::kBrickEdge * resolution) {}

std::uint64_t MapErrors::brickOf(const Eigen::Vector3d& p_w) const {
    return keyOf((p_w / brick_).array().floor().cast<int>());
}

/// The keyframes of a surface in a view, which may lie on the border of two bricks.
const std::vector<int>* MapErrors::findMakers(const Camera& camera, const Pose& T_w_c, unsigned u,
                                              unsigned v, double depth) const {
    for (const double beside : {0., kBeside, -kBeside}) {
        const auto found =
            makers_.find(brickOf(T_w_c * camera.unproject(u, v, depth + beside * brick_)));
        if (found != makers_.end()) return &found->second;
    }
    return nullptr;
}

void MapErrors::propagate(const Pose& T_next_now) {
    if (!poses_.empty()) cross_ = (adjoint(T_next_now) * cross_).eval();
}

void MapErrors::observe(const Matrix6& covariance, const Matrix6& information) {
    const Matrix6 left = Matrix6::Identity() + covariance * information;
    cross_ = left.partialPivLu().solve(cross_).eval();
}

MapErrors::Shares MapErrors::sharesOf(const View& map, const Camera& camera,
                                      const Pose& T_c_w) const {
    Shares shares;
    if (makers_.empty()) return shares;
    std::vector<int> at(poses_.size(), -1);  // index of a keyframe in shares.of
    const Pose T_w_c = T_c_w.inverse();
    for (unsigned v = 1; v + 1 < camera.height; v += kStride) {
        for (unsigned u = 1; u + 1 < camera.width; u += kStride) {
            if (!hasDepthAround(map, u, v)) continue;
            const std::vector<int>* makers = findMakers(camera, T_w_c, u, v, map.depth[v][u]);
            if (makers == nullptr) continue;
            const double part = 1. / static_cast<double>(makers->size());
            const Vector6 J = pixelJacobian(map, camera, u, v, kEveryPixel);
            const Matrix6 information = part * J * J.transpose();
            for (const int k : *makers) {
                if (at[k] < 0) {
                    at[k] = static_cast<int>(shares.of.size());
                    shares.of.push_back({k});
                }
                shares.of[at[k]].information += information;
                shares.of[at[k]].pixels += part;
            }
            shares.pixels += 1.;
            shares.inverseDepth += 1. / map.depth[v][u];
        }
    }
    return shares;
}

MapErrors::Relation MapErrors::relate(const View& map, const Camera& camera,
                                      const UncertainPose& T_c_w) const {
    const Shares shares = sharesOf(map, camera, T_c_w.mean);
    Relation relation;
    relation.relative = T_c_w.covariance;
    relation.mapWithKeyframes = Wide::Zero(6, cross_.cols());
    if (shares.of.empty()) return relation;
    relation.isMapped = true;

    // In directions without information every pixel counts the same.
    Matrix6 all = Matrix6::Zero();
    for (const auto& share : shares.of) all += share.information;
    relation.depth = shares.pixels / shares.inverseDepth;
    Vector6 unit;
    unit << Eigen::Vector3d::Constant(1. / relation.depth), Eigen::Vector3d::Ones();
    const double mean = std::max(1e-12, unit.cwiseInverse().cwiseAbs2().dot(all.diagonal()) / 6.);
    const Matrix6 least = Matrix6(kNegligible * mean * unit.cwiseAbs2().asDiagonal());
    const Eigen::LDLT<Matrix6> solver(all + least);
    Matrix6 cameraWithMap = Matrix6::Zero();
    std::vector<Matrix6> M;
    for (const auto& share : shares.of) {
        const Matrix6 part = share.information + share.pixels / shares.pixels * least;
        M.push_back(solver.solve(part) * adjoint(T_c_w.mean * poses_[share.keyframe].inverse()));
        const int k = 6 * share.keyframe;
        relation.mapWithKeyframes += M.back() * covariance_.middleRows<6>(k);
        cameraWithMap += cross_.middleCols<6>(k) * M.back().transpose();
    }
    for (std::size_t i = 0; i < M.size(); ++i) {
        relation.ofMap +=
            relation.mapWithKeyframes.middleCols<6>(6 * shares.of[i].keyframe) * M[i].transpose();
    }
    Matrix12 joint;  // of xi_c and m
    joint << (1. + kLeastRelative) * T_c_w.covariance, cameraWithMap, cameraWithMap.transpose(),
        relation.ofMap;
    joint = nonNegative(joint);
    relation.ofCamera = joint.topLeftCorner<6, 6>();
    relation.ofMap = joint.bottomRightCorner<6, 6>();
    const Matrix6 withMap = joint.topRightCorner<6, 6>();
    relation.withRelative = relation.ofCamera - withMap;
    relation.relative = symmetric(relation.withRelative - withMap.transpose() + relation.ofMap);
    return relation;
}

Alignment MapErrors::withoutWeak(const Alignment& alignment, const UncertainPose& T_c_w) {
    const Spectrum s = spectrum(alignment.information, alignment.meanDepth);
    const Vector6 kept = (s.values.array() > kWeakInformation).select(Vector6::Ones(), 0.);
    if (kept.minCoeff() > 0.) return alignment;
    const Matrix6 onto = s.unit.cwiseInverse().asDiagonal() * s.directions * kept.asDiagonal() *
                         s.directions.transpose() * s.unit.asDiagonal();
    const Matrix6 prior = T_c_w.covariance + 1e-12 * Matrix6::Identity();
    const Vector6 moved = deviation(alignment.T_c_w, T_c_w.mean);
    const Vector6 right = alignment.information * moved + prior.ldlt().solve(moved);
    Alignment strong = alignment;
    strong.information = symmetric(onto * alignment.information * onto.transpose());
    const Matrix6 left = Matrix6::Identity() + prior * strong.information;
    const Vector6 xi = left.partialPivLu().solve(prior * onto * right);
    strong.T_c_w = expSE3(xi) * T_c_w.mean;
    strong.covariance =
        larger(updateCovariance(prior, strong.information), symmetric(alignment.covariance));
    return strong;
}

UncertainPose MapErrors::align(const Relation& relation, const UncertainPose& T_c_w,
                               const Alignment& alignment) {
    if (!relation.isMapped) return {alignment.T_c_w, alignment.covariance};
    if (isUninformative(alignment)) return T_c_w;
    setImageNoise(alignment.information, relation.depth);
    const Matrix6& prior = relation.relative;
    // What a change of xi_c - m says about xi_c: P_cd P_d^-1.
    const Matrix6 share = prior.ldlt().solve(relation.withRelative.transpose()).transpose();
    const Matrix6 left = (Matrix6::Identity() + prior * alignment.information).inverse();
    const Matrix6 gain = share * (Matrix6::Identity() - left);
    cross_ -= (gain * (cross_ - relation.mapWithKeyframes)).eval();
    // Errors that repeat are in the covariance of the alignment, not in its information.
    const Matrix6 found =
        transported(alignment.covariance, -deviation(alignment.T_c_w, T_c_w.mean));
    const Matrix6 relative = smaller(larger(symmetric(left * prior), found), prior);
    const Pose moved = expSE3(share * logSE3(alignment.T_c_w * T_c_w.mean.inverse()));
    return {moved * T_c_w.mean,
            symmetric(relation.ofCamera - share * (prior - relative) * share.transpose())};
}

Matrix6 MapErrors::relocalize(const Relation& relation, const Alignment& alignment) {
    if (!relation.isMapped) return alignment.covariance;
    setImageNoise(alignment.information, relation.depth);
    cross_ = relation.mapWithKeyframes;
    return symmetric(relation.ofMap + alignment.covariance);
}

/// The noise of an image displaces it as it does an alignment, at most by kWeakSigma. An image that
/// was not aligned has the noise of the last one that was; one before the first alignment, of that.
void MapErrors::setImageNoise(const Matrix6& information, double depth) {
    const Spectrum s = spectrum(information, depth);
    const Vector6 variances = s.values.cwiseMax(kWeakInformation).cwiseInverse();
    const Matrix6 axes = s.unit.asDiagonal() * s.directions;
    imageNoise_ = symmetric(axes * variances.asDiagonal() * axes.transpose());
    for (const int k : withoutNoise_) covariance_.block<6, 6>(6 * k, 6 * k) += *imageNoise_;
    withoutNoise_.clear();
}

int MapErrors::addPose(const UncertainPose& T_c_w) {
    if (!imageNoise_) withoutNoise_.push_back(static_cast<int>(poses_.size()));
    const Matrix6 noise = imageNoise_.value_or(Matrix6::Zero());
    return add(T_c_w.mean, T_c_w.covariance + noise, cross_, T_c_w.covariance);
}

void MapErrors::addMap(const Pose& T_k_w, const Matrix6& covariance,
                       const std::vector<Eigen::Array3i>& bricks) {
    const int k = add(T_k_w, covariance, Wide::Zero(6, cross_.cols()), Matrix6::Zero());
    for (const Eigen::Array3i& brick : bricks) makers_[keyOf(brick)].push_back(k);
}

/// @param withOthers cross-covariance with the errors of the keyframes so far
/// @param withCamera cross-covariance with the error of the camera
int MapErrors::add(const Pose& T_k_w, const Matrix6& covariance, const Wide& withOthers,
                   const Matrix6& withCamera) {
    const int k = static_cast<int>(poses_.size());
    poses_.push_back(T_k_w);
    covariance_.conservativeResize(6 * k + 6, 6 * k + 6);
    covariance_.bottomLeftCorner(6, 6 * k) = withOthers;
    covariance_.topRightCorner(6 * k, 6) = withOthers.transpose();
    covariance_.bottomRightCorner<6, 6>() = covariance;
    cross_.conservativeResize(6, 6 * k + 6);
    cross_.rightCols<6>() = withCamera;
    return k;
}

void MapErrors::addSurfaces(int k, const ImageF& depth, const Camera& camera) {
    const Pose T_w_c = poses_[k].inverse();
    for (unsigned v = 0; v < depth.getHeight(); ++v) {
        for (unsigned u = 0; u < depth.getWidth(); ++u) {
            if (!(depth[v][u] > 0.F)) continue;
            const std::uint64_t brick = brickOf(T_w_c * camera.unproject(u, v, depth[v][u]));
            std::vector<int>& makers = makers_[brick];
            if (removed_.erase(brick) > 0) makers.clear();
            const bool isNew = makers.empty() || makers.back() != k;
            if (isNew && makers.size() < kMostMakers) makers.push_back(k);
        }
    }
}

void MapErrors::removeSurfaces(const ImageF& depth, const Camera& camera, const Pose& T_c_w) {
    const Pose T_w_c = T_c_w.inverse();
    for (unsigned v = 0; v < depth.getHeight(); ++v) {
        for (unsigned u = 0; u < depth.getWidth(); ++u) {
            if (!(depth[v][u] > 0.F)) continue;
            for (const double beside : {kBeside, -kBeside}) {
                removed_.insert(
                    brickOf(T_w_c * camera.unproject(u, v, depth[v][u] + beside * brick_)));
            }
        }
    }
}

}  // namespace photonav
