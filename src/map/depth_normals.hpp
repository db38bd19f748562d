// SPDX-License-Identifier: BSD-3-Clause
// Normals of the surfaces in a depth image.
#pragma once

#include <array>
#include <vector>

#include "geometry/camera.hpp"

namespace photonav {

/// Computes unit normals that point toward the camera, from differences between the 3-D points of
/// pixels at a given distance to each side. Only one side is used if the other has no depth or lies
/// beyond a depth edge. Normals are computed and stored for one row at a time.
class DepthNormals {
  public:
    /// @param depth z in the camera frame [m]; 0: not measured. Must outlive this object
    /// @param camera must outlive this object
    /// @param R rotation from the camera frame to the frame of the normals
    /// @param reach distance over which differences are taken to each side [m]: large compared with
    ///        the noise of the depth, small compared with the surfaces
    /// @param depthJump largest relative second difference of inverse depth that is no depth edge
    DepthNormals(const ImageF& depth, const Camera& camera, const Eigen::Matrix3f& R, double reach,
                 double depthJump);

    /// Computes the normals of row v, which replace those of the last row.
    void computeRow(unsigned v);

    /// Unit normal at column u of the row computed last; zero if it cannot be computed.
    Eigen::Vector3f at(unsigned u) const { return {row_[0][u], row_[1][u], row_[2][u]}; }

  private:
    void computePacket(int u, int v);

    const ImageF& depth_;
    const Camera& camera_;
    Eigen::Matrix3f R_;
    float reach_, jump_;
    std::array<std::vector<float>, 3> row_;  // x, y, z; whole packets
};

}  // namespace photonav
