// SPDX-License-Identifier: BSD-3-Clause
// The errors of a map that was made on the flight itself.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "alignment/alignment.hpp"

namespace photonav {

/// A map fused at believed poses is displaced as these poses are wrong. Whoever aligns an image to
/// it finds the pose relative to the keyframes that made what is in view, not the pose in the
/// world.
///
/// The covariance of the camera's pose is therefore kept jointly with those of all keyframes: a
/// Schmidt-Kalman filter, in which keyframes are considered but, since the map is not fused anew,
/// not corrected. With xi_c the error of the camera and xi_k that of keyframe k (left, in the frame
/// of each camera), the part of the map in view is displaced by
///     m = sum_k M_k xi_k,   M_k = (sum_j Lambda_j)^-1 Lambda_k Ad(T_c_k),
/// where Lambda_k is the information of the pixels whose cells keyframe k has fused (shared equally
/// between several). An alignment narrows xi_c - m alone: the belief never becomes better than the
/// map in view was when it was made, and falls when the start is seen again.
class MapErrors {
  public:
    /// @param resolution edge of the map's cells [m]
    explicit MapErrors(double resolution);

    /// What a view of the map has to do with the errors of its keyframes.
    struct Relation {
        Matrix6 relative = Matrix6::Zero();  ///< covariance of xi_c - m
        Matrix6 ofMap = Matrix6::Zero();     ///< covariance of m
        Matrix6 withMap = Matrix6::Zero();   ///< covariance of xi_c - m with m
        Eigen::Matrix<double, 6, Eigen::Dynamic> mapWithKeyframes;
        double views = 0.;  ///< keyframes that made what a pixel shows, mean; 0: none in view
    };

    /// The camera has moved. @param T_next_now its motion
    void propagate(const Pose& T_next_now);

    /// Something else than the map has informed of the pose in the world.
    /// @param covariance of the pose before; both in the camera frame, left
    void observe(const Matrix6& covariance, const Matrix6& information);

    /// @param map view predicted from the believed pose
    Relation relate(const View& map, const Camera& camera, const UncertainPose& T_c_w) const;

    /// An alignment without the directions that the image informs little of. In a map of few noisy
    /// images a nearly uniform surface seems to inform a little of all directions; from image to
    /// image this would add up.
    /// @param T_c_w prior of the alignment
    static Alignment withoutWeak(const Alignment& alignment, const UncertainPose& T_c_w);

    /// An image was aligned with the prior `relation.relative`.
    /// @return covariance of the camera's pose in the world
    Matrix6 align(const Relation& relation, const Alignment& alignment);

    /// The same where tracking was lost: the pose in the map is that of the alignment alone.
    Matrix6 relocalize(const Relation& relation, const Alignment& alignment);

    /// The present pose is kept: its image is fused into the map, now or later.
    /// @param T_c_w belief @return number of this keyframe
    int addPose(const UncertainPose& T_c_w);

    /// The image of a keyframe was fused, at the pose believed when it was taken.
    /// @param depth of the surfaces fused [m]; 0: none
    void addSurfaces(int keyframe, const ImageF& depth, const Camera& camera);

    std::size_t keyframes() const { return poses_.size(); }

  private:
    using Wide = Eigen::Matrix<double, 6, Eigen::Dynamic>;
    struct Shares;
    Shares sharesOf(const View& map, const Camera& camera, const Pose& T_c_w) const;
    Matrix6 joined(const Relation& relation, const Matrix6& relative, const Matrix6& withMap) const;

    std::uint64_t brickOf(const Eigen::Vector3d& p_w) const;

    double brick_;                // edge of a brick of cells, whose keyframes are kept [m]
    std::vector<Pose> poses_;     // T_k_w
    Eigen::MatrixXd covariance_;  // of all keyframes
    Wide cross_ = Wide(6, 0);     // of the camera's error with theirs
    std::unordered_map<std::uint64_t, std::vector<int>> makers_;  // keyframes of a brick
};

}  // namespace photonav
