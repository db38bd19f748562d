// SPDX-License-Identifier: BSD-3-Clause
// The map of record: an OctoMap whose leaves carry the grey value of their six faces.
#pragma once

#include <octomap/OccupancyOcTreeBase.h>
#include <octomap/OcTreeNode.h>

#include <array>
#include <string>

#include "view.hpp"

namespace photonav {

/// What a cell that no ray has visited counts as. There is no silent default anywhere.
enum class UnknownPolicy { free, occupied };

/// Faces in the order -x, +x, -y, +y, -z, +z of the outward normal.
struct FaceTexture {
    float mean = 0.F;    ///< grey value in [0, 1]
    float weight = 0.F;  ///< sum of observation weights; 0: never seen
};

class TexturedOcTreeNode : public octomap::OcTreeNode {
  public:
    std::array<FaceTexture, 6> faces;
};

}  // namespace photonav
