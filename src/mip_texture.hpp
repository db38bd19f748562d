// SPDX-License-Identifier: BSD-3-Clause
// Texture pyramids, laid out for bilinear lookup.
#pragma once

#include <vector>

#include "types.hpp"

namespace photonav {

/// Successively halved, area-averaged copies of a texture down to 1 x 1. Every level carries one
/// more column and row that repeat the first, so that the right and lower neighbours of any texel
/// are always the next ones in memory.
class MipTexture {
  public:
    struct Level {
        int width, height;  ///< without the repeated column and row
        int pitch;          ///< floats from row to row
        std::size_t start;  ///< of the first texel
    };

    explicit MipTexture(const ImageF& image);

    const std::vector<Level>& levels() const { return levels_; }
    const float* texels(std::size_t level) const { return texels_.data() + levels_[level].start; }

  private:
    void append(const ImageF& image);

    std::vector<Level> levels_;
    std::vector<float> texels_;
};

}  // namespace photonav
