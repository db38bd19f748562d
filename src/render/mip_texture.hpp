// SPDX-License-Identifier: BSD-3-Clause
// Texture pyramids, laid out for bilinear lookup.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/types.hpp"

namespace photonav {

/// Successively halved, area-averaged copies of a texture down to 1 x 1, in 16 bits per grey value.
/// Every level carries one more column and row that repeat the first, so that the right and lower
/// neighbours of a texel follow it in memory.
class MipTexture {
  public:
    struct Level {
        float width, height;                ///< texels
        float inverseWidth, inverseHeight;  ///< 1 / width, 1 / height
        int pitch;                          ///< entries from row to row
        std::size_t start;                  ///< of the first entry
    };
    static constexpr float kOne = 65535.F;  ///< what grey value 1 is stored as

    explicit MipTexture(const ImageF& image);

    const std::vector<Level>& levels() const { return levels_; }

    const std::uint16_t* texels(std::size_t level) const {
        return texels_.data() + levels_[level].start;
    }

    /// The grey value of a texture without detail.
    std::optional<float> uniform() const { return uniform_; }

  private:
    void append(const ImageF& image);

    std::vector<Level> levels_;
    std::vector<std::uint16_t> texels_;
    std::optional<float> uniform_;
};

}  // namespace photonav
