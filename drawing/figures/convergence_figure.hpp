// SPDX-License-Identifier: BSD-3-Clause
// Pictures of a depth filter: depth, state and error of each pixel.
#pragma once

#include <string>
#include <vector>

#include "depth/depth_filter.hpp"
#include "figures/images.hpp"

namespace photonav {

/// The reference image, the converged depths, the state of each pixel (converged, given up,
/// searching) and, if depth was recorded, the relative depth error.
/// @param recorded recorded depth of the reference image [m], 0: not measured; same size
/// @param caption caption of the reference image
std::vector<CaptionedImage> convergenceImages(const DepthFilter& filter, const ImageF& recorded,
                                              const std::string& caption);

/// A figure with at most five reference images spread over a recording, one row each.
class ConvergenceFigure {
  public:
    /// Adds the next reference image. Their number need not be known in advance: when there are too
    /// many rows, every second row is removed.
    /// @param timestamp of the reference image [s]
    void add(const DepthFilter& filter, const ImageF& recorded, double timestamp);

    std::size_t references() const { return references_; }  ///< number of images added
    std::size_t rows() const { return rows_.size(); }
    Figure figure() const { return imagesFigure(rows_); }

  private:
    std::vector<std::vector<CaptionedImage>> rows_;  // one for every stride_-th reference image
    std::size_t stride_ = 1;
    std::size_t references_ = 0;
};

}  // namespace photonav
