// SPDX-License-Identifier: BSD-3-Clause
// A map from images and poses alone, and how its depths compare with the recorded ones.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "map_comparison.hpp"
#include "map_fusion.hpp"
#include "monocular_depth.hpp"
#include "report.hpp"
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

    /// {references, references_given_up; converged, given_up, searching: shares of their pixels;
    /// completeness, median_relative_error, p90_relative_error, share_above_10_percent: of the
    /// pixels with recorded depth, null when there are none}.
    nlohmann::json result() const;

    /// What a few references spread over the recording have learned; none when there was none.
    std::optional<ReportFigure> figure() const;

  private:
    void fuseReference(const DepthFilter& filter);
    void count(const DepthFilter& filter, const ImageF& found);
    void draw(const DepthFilter& filter);

    TexturedOcTree& map_;
    const Camera& camera_;
    FusionOptions options_;
    MonocularDepth depth_;
    ImageF recorded_;        ///< depth of the current reference
    double timestamp_ = 0.;  ///< of the same [s]
    int references_ = 0;
    std::array<std::size_t, 3> states_{};    ///< pixels of references by DepthState
    std::vector<std::vector<Panel>> drawn_;  ///< of every stride_-th reference
    int stride_ = 1;
    std::size_t pixels_ = 0;     ///< of references, with recorded depth
    std::vector<float> errors_;  ///< relative, where both are known
};

}  // namespace photonav
