// SPDX-License-Identifier: BSD-3-Clause
// The Fisher Information Field (FIF; Zhang and Scaramuzza 2020) behind an interface without its
// headers: information of 3-D landmarks, summed per voxel, for a camera of any orientation.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/types.hpp"
#include "photometry/view.hpp"

namespace photonav::peers {

/// A landmark as FIF gets it from structure from motion.
struct Landmark {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();        ///< world frame [m]
    Eigen::Vector3d viewDirection = Eigen::Vector3d::UnitZ();  ///< mean direction towards the
                                                               ///< cameras that observed it
};

/// FIF's options, by default as in its configuration for a room (act_map_euroc.yaml); the pitch of
/// the depth is that of its warehouse.
struct FifOptions {
    Eigen::AlignedBox3d bounds;     ///< positions that are asked for, world frame [m]
    double voxel = 0.25;            ///< edge of a voxel [m]
    int voxelsPerSide = 5;          ///< of a block of voxels
    double depthStep = 2.;          ///< pitch of a depth voxel's directions [degrees]
    double leastDistance = 0.1;     ///< from a landmark [m]
    double largestDistance = 7.;    ///< from a landmark [m]
    double largestViewAngle = 60.;  ///< from Landmark::viewDirection [degrees]
};

/// One field: a model of visibility, and 6x6 information or its trace alone.
class FifField {
  public:
    virtual ~FifField() = default;
    virtual std::string name() const = 0;
    /// False for a field of the trace alone.
    virtual bool hasMatrix() const = 0;

    /// FIF's own query of the trace, which is about the world's origin; factors are interpolated
    /// between voxels.
    virtual double trace(const Pose& T_c_w) const = 0;
    /// FIF's own query of log(det + 1), interpolated; 0 for a field of the trace.
    virtual double logDet(const Pose& T_c_w) const = 0;
    /// The interpolated information by bearings with a standard deviation of 1 rad, about the
    /// camera centre: camera frame, left perturbation, order (rho, phi). Zero for a field of the
    /// trace, and outside of the field.
    virtual Matrix6 information(const Pose& T_c_w) const = 0;

    virtual std::size_t voxels() const = 0;
    /// Bytes of the factors of one voxel.
    virtual std::size_t factorBytes() const = 0;
    virtual double buildSeconds() const = 0;  ///< processor time, without rendering depth

    struct Block;
    /// Adds the landmarks that are visible from the voxels of a block.
    virtual void integrate(const Block& block) = 0;
};

/// Makes the fields and builds them from landmarks, with occlusion by the depth of our views.
/// The quadratic model of visibility has the cone of FIF's configurations, 45 degrees about the
/// axis: that of a narrower cone is negative beside the axis.
/// @param gaussianProcess folder of the parameters of a visibility by a Gaussian process
std::vector<std::unique_ptr<FifField>> makeFifFields(const FifOptions& options,
                                                     const std::string& gaussianProcess,
                                                     const ViewSource& views,
                                                     const std::vector<Landmark>& landmarks);

}  // namespace photonav::peers
