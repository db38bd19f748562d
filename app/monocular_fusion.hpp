// SPDX-License-Identifier: BSD-3-Clause
// A map from images and poses alone, and how its depths compare with the recorded ones.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "map_fusion.hpp"
#include "monocular_depth.hpp"
#include "sequence.hpp"

namespace photonav {

class MonocularFusion {
  public:
    /// @param map, camera must outlive it
    MonocularFusion(TexturedOcTree& map, const Camera& camera, const FusionOptions& options);

    /// The next image; its recorded depth is used for comparison only.
    /// @throws std::invalid_argument see fuse()
    void add(const RecordedFrame& frame);

    /// Fuses what the last reference has learned.
    void finish();

    /// {references, completeness, median_relative_error, p90_relative_error,
    /// share_above_10_percent} of the pixels with recorded depth; errors are null when there are
    /// none.
    nlohmann::json result() const;

  private:
    void fuseReference(const DepthFilter& filter);

    TexturedOcTree& map_;
    const Camera& camera_;
    FusionOptions options_;
    MonocularDepth depth_;
    ImageF recorded_;  ///< depth of the current reference
    int references_ = 0;
    std::size_t pixels_ = 0;     ///< of references, with recorded depth
    std::vector<float> errors_;  ///< relative, where both are known
};

}  // namespace photonav
