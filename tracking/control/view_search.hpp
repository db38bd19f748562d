// SPDX-License-Identifier: BSD-3-Clause
// Searches a nearby view that reduces the uncertainty of the pose, after the planned view did not.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/uncertain_pose.hpp"
#include "photometry/photometric.hpp"

namespace photonav {

/// Standard deviation of the position along its widest direction [m].
/// @param covariance of T_c_w, camera frame
double widestSigma(const Matrix6& covariance);

/// Whether the body may be at a position: free of collision.
using IsFree = std::function<bool(const Eigen::Vector3d& p_w)>;

/// Whether the straight line between two positions is free, checked every 5 cm.
bool isLineFree(const Eigen::Vector3d& from_w, const Eigen::Vector3d& to_w, const IsFree& isFree);

/// Views that would narrow a belief, wherever in it the camera truly is.
class ViewSearch {
  public:
    ViewSearch(std::shared_ptr<const ViewSource> map, const Camera& camera, const Pose& T_b_c,
               const PhotometricOptions& photometric)
        : map_(std::move(map)), camera_(camera), T_b_c_(T_b_c), photometric_(photometric) {}

    /// The nearest body pose level with `T_w_b` from which an image should narrow the belief and
    /// which can be reached on a straight line; not one that was visited. The farthest ones are a
    /// field of view beyond three standard deviations.
    /// @param isFree whether the body may be believed to be at a place
    std::optional<Pose> nearest(const UncertainPose& belief, const Pose& T_w_b,
                                const IsFree& isFree) const;

    /// Whether an image taken from a believed body pose should at least halve the variance along
    /// the widest direction of the position, wherever within a standard deviation the camera is.
    bool narrows(const UncertainPose& belief, const Pose& T_w_b) const;

    /// An image from there did not narrow the belief.
    void visited(const Pose& T_w_b) { visited_.push_back(T_w_b.translation()); }

  private:
    double footprint(const Pose& T_w_b) const;
    bool wasVisited(const Pose& T_w_b, double apart) const;

    std::shared_ptr<const ViewSource> map_;
    Camera camera_;
    Pose T_b_c_;
    PhotometricOptions photometric_;
    std::vector<Eigen::Vector3d> visited_;
};

}  // namespace photonav
