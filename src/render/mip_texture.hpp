// SPDX-License-Identifier: BSD-3-Clause
// Texture pyramids, laid out for bilinear lookup.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/types.hpp"

namespace photonav {

/// Copies of a texture at half, a quarter, ... of its size down to 1 x 1, averaged over area, with
/// 16 bits per grey value. Every level has one more column and row that repeat the first, so that
/// the right and lower neighbours of a texel follow it in memory.
class MipTexture {
  public:
    struct Level {
        float width, height;                ///< texels
        float inverseWidth, inverseHeight;  ///< 1 / width, 1 / height
        int pitch;                          ///< number of entries per row
        std::size_t start;                  ///< index of the first entry
    };
    static constexpr float kOne = 65535.F;  ///< stored value of grey value 1

    explicit MipTexture(const ImageF& image);

    const std::vector<Level>& levels() const { return levels_; }

    /// The entries of a level, row by row.
    const std::uint16_t* texels(std::size_t level) const {
        return texels_.data() + levels_[level].start;
    }

    /// The grey value of a uniform texture; none for other textures.
    std::optional<float> uniform() const { return uniform_; }

  private:
    void append(const ImageF& image);

    std::vector<Level> levels_;
    std::vector<std::uint16_t> texels_;
    std::optional<float> uniform_;
};

}  // namespace photonav
