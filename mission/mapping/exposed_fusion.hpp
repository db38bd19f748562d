// SPDX-License-Identifier: BSD-3-Clause
// Fuses the images of a camera whose exposure changes.
#pragma once

#include <memory>

#include "map/map_fusion.hpp"
#include "render/voxel_snapshots.hpp"

namespace photonav {

/// Fuses images into a map, as fuse() does, with the exposure of the first image. The gain of every
/// later image is estimated by a view of the map at its pose (fittedGain()), and its grey values
/// are divided by it. Otherwise the images of a camera with automatic exposure would leave edges in
/// the map, where one ends and another one begins.
class ExposedFusion {
  public:
    /// @param map    must outlive this object
    /// @param estimate whether gains are estimated; otherwise all are taken as equal
    ExposedFusion(TexturedOcTree& map, const Camera& camera, bool estimate);

    /// @param observed as the camera took it
    /// @throws as fuse()
    void add(View observed, const Pose& T_c_w, const FusionOptions& options);

    /// Of the last image, relative to the map.
    double gain() const { return gain_; }

  private:
    void estimateGain(const ImageF& observed, const Pose& T_c_w);

    TexturedOcTree& map_;
    Camera camera_, small_;  ///< of the images, and of the views that they are compared with
    bool estimate_;
    std::unique_ptr<VoxelSnapshots> views_;  ///< of the map; null before the first image
    View view_;
    double gain_ = 1.;
};

}  // namespace photonav
