// SPDX-License-Identifier: BSD-3-Clause
// A map from images and poses alone, and how its depths compare with the recorded ones.
#pragma once

#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "dataset/sequence.hpp"
#include "depth/monocular_depth.hpp"
#include "map/map_fusion.hpp"

namespace photonav {

class MonocularFusion {
  public:
    /// A reference image whose depths have been fused.
    struct Reference {
        const DepthFilter& filter;
        const ImageF& recorded;  ///< depth [m], 0: not known
        double timestamp;        ///< [s]
    };

    /// @param map, camera must outlive it
    /// @param onReference called with every reference image; may be missing
    MonocularFusion(TexturedOcTree& map, const Camera& camera, const FusionOptions& options,
                    std::function<void(const Reference&)> onReference);

    /// The next image; its recorded depth is used for comparison only.
    /// @throws std::invalid_argument see fuse()
    void add(const RecordedFrame& frame);

    /// Fuses the depths of the last reference image.
    void finish();

    /// {references, references_given_up; converged, given_up, searching: shares of their pixels;
    /// completeness, median_relative_error, p90_relative_error, share_above_10_percent: of the
    /// pixels with recorded depth, null when there are none}.
    nlohmann::json result() const;

  private:
    void fuseReference(const DepthFilter& filter);
    void count(const DepthFilter& filter, const ImageF& found);

    TexturedOcTree& map_;
    const Camera& camera_;
    FusionOptions options_;
    std::function<void(const Reference&)> onReference_;
    MonocularDepth depth_;
    ImageF recorded_;        ///< depth of the current reference
    double timestamp_ = 0.;  ///< of the same [s]
    int references_ = 0;
    std::array<std::size_t, 3> states_{};  ///< pixels of references by DepthState
    std::size_t pixels_ = 0;               ///< of references, with recorded depth
    std::vector<float> errors_;            ///< relative, where both are known
};

}  // namespace photonav
