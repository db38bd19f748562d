// SPDX-License-Identifier: BSD-3-Clause
// Normals of the surfaces in a depth image.
#pragma once

#include <array>
#include <vector>

#include "geometry/camera.hpp"

namespace photonav {

/// Unit normals toward the camera from differences of the image's points over a given length to
/// each side; to one side where the other has no depth or lies beyond a depth edge. Rows are
/// computed one by one, since a map wants them only while it looks at their pixels.
class DepthNormals {
  public:
    /// @param depth, camera must outlive this
    /// @param R rotates normals from the camera frame
    /// @param reach of the differences [m]: large against the depth's noise, small against the
    ///        surfaces
    /// @param depthJump a relative second difference of inverse depth above this is a depth edge
    DepthNormals(const ImageF& depth, const Camera& camera, const Eigen::Matrix3f& R, double reach,
                 double depthJump);

    void computeRow(unsigned v);

    /// Of a pixel in the row computed last; zero where there is none.
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
