// SPDX-License-Identifier: BSD-3-Clause
// The state of a depth filter, pixel by pixel.
#pragma once

#include <string>
#include <vector>

#include "depth/depth_filter.hpp"
#include "figures/images.hpp"

namespace photonav {

/// The reference image; the depths that have converged; which pixels have converged, were given up
/// or are still open; and, where there are recorded depths, the error of the estimated ones.
/// @param recorded depth of the reference [m], 0: not known; of the same size
/// @param caption of the reference
std::vector<CaptionedImage> convergenceImages(const DepthFilter& filter, const ImageF& recorded,
                                              const std::string& caption);

/// A few reference images spread over a recording, a row each.
class ConvergenceFigure {
  public:
    /// The next reference image. How many there will be is not known: when there are too many rows,
    /// every other one is dropped.
    void add(const DepthFilter& filter, const ImageF& recorded, double timestamp);

    std::size_t references() const { return references_; }
    std::size_t rows() const { return rows_.size(); }
    Figure figure() const { return imagesFigure(rows_); }

  private:
    std::vector<std::vector<CaptionedImage>> rows_;  // of every stride_-th reference
    std::size_t stride_ = 1;
    std::size_t references_ = 0;
};

}  // namespace photonav
