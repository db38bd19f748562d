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

    /// Whether a part of the texture is uniform: then it can be worth asking uniformWithin().
    bool hasUniformTiles() const { return hasUniformTiles_; }

    /// The entry that all texels of level 0 within a box have. None if they differ, and in some
    /// cases where they do not: beside a tile that is not uniform, and where the box reaches into
    /// another repetition of the texture.
    /// @param low, high corners of the box [texels]; any repetition
    std::optional<std::uint16_t> uniformWithin(const Eigen::Array2d& low,
                                               const Eigen::Array2d& high) const;

  private:
    static constexpr int kTile = 16;  // texels along a side

    void append(const ImageF& image);
    void findUniformTiles();
    bool isUniform(int tileX, int tileY) const;
    int& rough(int x, int y) { return rough_[std::size_t(y) * (tiles_.x() + 1) + x]; }
    int rough(int x, int y) const { return rough_[std::size_t(y) * (tiles_.x() + 1) + x]; }

    std::vector<Level> levels_;
    std::vector<std::uint16_t> texels_;
    std::optional<float> uniform_;
    Eigen::Array2i tiles_ = Eigen::Array2i::Zero();  // of level 0, in columns and rows
    std::vector<int> rough_;  // (x, y): tiles that are not uniform, of the first x columns, y rows
    bool hasUniformTiles_ = false;
};

}  // namespace photonav
