// SPDX-License-Identifier: BSD-3-Clause
// The errors of a map that is built on the same flight that it is used for.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "alignment/alignment.hpp"

namespace photonav {

/// A map is fused at estimated poses, and is displaced by their errors. An alignment to this map
/// gives the pose relative to the keyframes whose images were fused into the part in view, not the
/// pose in the world.
///
/// Therefore the joint covariance of the camera pose and of all keyframes is kept in a
/// Schmidt-Kalman filter: the errors of keyframes are considered but not corrected, because the map
/// is not fused again. With xi_c the error of the camera pose and xi_k the displacement of the
/// image of keyframe k in the map (left perturbations, in the frame of each camera), the part of
/// the map in view is displaced by
///     m = sum_k M_k xi_k,   M_k = (sum_j Lambda_j)^-1 Lambda_k Ad(T_c_k),
/// where Lambda_k is the information of the pixels whose cells were fused by keyframe k (divided
/// equally between several keyframes). xi_k is the error of the keyframe's pose and the noise of
/// its image, which is the same in every alignment to it. The two count as independent.
///
/// An alignment measures d = xi_c - m. If it changes d by delta, it changes xi_c by
///     P_cd P_d^-1 delta,   P_cd covariance of xi_c with d, P_d covariance of d.
/// So an alignment adds what is known of the error of this part of the map, and no more: without
/// other measurements the pose does not become more certain than it was when the part was made.
/// The covariance falls when the start comes into view again. Where the gyroscope and the vertical
/// know the rotation better than the map does, the map does not turn the camera.
class MapErrors {
  public:
    /// @param resolution edge of the map's cells [m]
    explicit MapErrors(double resolution);

    /// The joint covariance of the camera pose and the displacement m of the map in view.
    struct Relation {
        bool isMapped = false;  ///< whether surfaces that a keyframe has made are in view
        double depth = 0.;      ///< mean depth of these surfaces [m]
        Matrix6 relative = Matrix6::Zero();  ///< covariance of d = xi_c - m
        /// Covariance of xi_c, larger by a share of 1e-4: d is never known exactly.
        Matrix6 ofCamera = Matrix6::Zero();
        Matrix6 withRelative = Matrix6::Zero();  ///< cross-covariance of xi_c with d
        Matrix6 ofMap = Matrix6::Zero();         ///< covariance of m
        /// Cross-covariance of m with the displacements of all keyframes.
        Eigen::Matrix<double, 6, Eigen::Dynamic> mapWithKeyframes;
    };

    /// Propagates the errors over a motion of the camera.
    void propagate(const Pose& T_next_now);

    /// Updates by a measurement of the pose in the world that does not come from the map.
    /// @param covariance of the pose before the measurement
    /// @param information of the measurement; both for the left perturbation, camera frame
    void observe(const Matrix6& covariance, const Matrix6& information);

    /// Relates the belief of the camera pose to the map in view.
    /// @param map view of the map from the mean of the belief
    Relation relate(const View& map, const Camera& camera, const UncertainPose& T_c_w) const;

    /// Removes from an alignment the directions about which the image has little information. In a
    /// map of few noisy images, a nearly uniform surface seems to have a little information about
    /// all directions, which would add up from image to image.
    /// @param T_c_w prior of the alignment
    static Alignment withoutWeak(const Alignment& alignment, const UncertainPose& T_c_w);

    /// Updates by an image that was aligned with the prior covariance `relation.relative`.
    /// @param T_c_w belief of the pose in the world before the image
    /// @return belief after it
    UncertainPose align(const Relation& relation, const UncertainPose& T_c_w,
                        const Alignment& alignment);

    /// Updates by an image that was aligned while tracking was lost: the pose in the map follows
    /// from the alignment alone.
    /// @return covariance of the camera pose in the world
    Matrix6 relocalize(const Relation& relation, const Alignment& alignment);

    /// Adds the present pose as a keyframe, whose image is fused into the map now or later.
    /// @param T_c_w belief of the present pose
    /// @return number of this keyframe
    int addPose(const UncertainPose& T_c_w);

    /// Reports that the image of a keyframe was fused at the mean of its belief.
    /// @param depth depth of the fused surfaces [m]; 0: none
    void addSurfaces(int keyframe, const ImageF& depth, const Camera& camera);

    /// Reports that surfaces were removed from the map. The next image that is fused into their
    /// bricks replaces the keyframes that had made them; until then, what is left there keeps its
    /// errors.
    /// @param depth view of these surfaces [m], from the pose T_c_w; 0: none
    void removeSurfaces(const ImageF& depth, const Camera& camera, const Pose& T_c_w);

    /// Adds a map that was known before the flight, as one keyframe: it may be displaced as a
    /// whole, by a motion that has nothing to do with the error of the camera's pose.
    /// @param T_k_w a frame, in which the motion is small
    /// @param covariance of the motion, left perturbation of T_k_w
    /// @param bricks with surfaces, see MapChange
    void addMap(const Pose& T_k_w, const Matrix6& covariance,
                const std::vector<Eigen::Array3i>& bricks);

    std::size_t keyframes() const { return poses_.size(); }

  private:
    using Wide = Eigen::Matrix<double, 6, Eigen::Dynamic>;
    struct Shares;
    Shares sharesOf(const View& map, const Camera& camera, const Pose& T_c_w) const;
    void setImageNoise(const Matrix6& information, double depth);

    int add(const Pose& T_k_w, const Matrix6& covariance, const Wide& withOthers,
            const Matrix6& withCamera);
    std::uint64_t brickOf(const Eigen::Vector3d& p_w) const;
    const std::vector<int>* findMakers(const Camera& camera, const Pose& T_w_c, unsigned u,
                                       unsigned v, double depth) const;

    double brick_;                // edge of a brick of cells, whose keyframes are kept [m]
    std::vector<Pose> poses_;     // T_k_w
    Eigen::MatrixXd covariance_;  // of the displacements of all keyframes' images
    Wide cross_ = Wide(6, 0);     // of the camera's error with theirs
    std::unordered_map<std::uint64_t, std::vector<int>> makers_;  // keyframes of a brick
    std::optional<Matrix6> imageNoise_;  // of the last image that was aligned; none: not one was
    std::vector<int> withoutNoise_;      // keyframes from before it
    std::unordered_set<std::uint64_t> removed_;  // bricks whose surfaces were removed
};

}  // namespace photonav
