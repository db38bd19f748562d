// SPDX-License-Identifier: BSD-3-Clause
// Mapping from the images of one camera and their poses: estimates depth by depth filters, fuses
// it, and compares it with recorded depth if there is any.
#pragma once

#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "dataset/sequence.hpp"
#include "depth/monocular_depth.hpp"
#include "mapping/exposed_fusion.hpp"

namespace photonav {

/// Fuses the images of a recording, one after the other, into a map.
class MonocularFusion {
  public:
    /// A reference image whose depth filter is finished.
    struct Reference {
        const DepthFilter& filter;
        const ImageF& recorded;  ///< recorded depth of the image [m]; 0: not measured
        double timestamp;        ///< of the image [s]
    };

    /// @param fusion  fuses the views of references; must outlive this object
    /// @param camera  must outlive this object
    /// @param onReference called with every reference image before its depth is fused; may be empty
    MonocularFusion(ExposedFusion& fusion, const Camera& camera, const FusionOptions& options,
                    std::function<void(const Reference&)> onReference);

    /// Adds the next image. Recorded depth is only compared, never fused.
    /// @throws std::invalid_argument see fuse()
    void add(const RecordedFrame& frame);

    /// Fuses the depth of the last reference image.
    void finish();

    /// Statistics of all reference images: {references, references_given_up: numbers of images;
    /// converged, given_up, searching: shares of their pixels by DepthState; completeness,
    /// median_relative_error, p90_relative_error, share_above_10_percent: over the pixels with
    /// recorded depth, null without them}.
    nlohmann::json result() const;

  private:
    void fuseReference(const DepthFilter& filter);
    void count(const DepthFilter& filter, const ImageF& found);

    ExposedFusion& fusion_;
    FusionOptions options_;
    std::function<void(const Reference&)> onReference_;
    MonocularDepth depth_;
    ImageF recorded_;        ///< depth of the current reference
    double timestamp_ = 0.;  ///< of the current reference [s]
    int references_ = 0;
    std::array<std::size_t, 3> states_{};  ///< number of pixels by DepthState
    std::size_t pixels_ = 0;               ///< number of pixels with recorded depth
    std::vector<float> errors_;            ///< relative depth errors
};

}  // namespace photonav
