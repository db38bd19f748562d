// SPDX-License-Identifier: BSD-3-Clause
#include "render/mip_texture.hpp"

#include <algorithm>
#include <cmath>

namespace photonav {
namespace {

/// The texels of the finer level that a texel of the coarser one averages: 2, or 3 (one or two of
/// them in part) where the finer level is odd.
struct Taps {
    unsigned first = 0;
    std::array<float, 4> weights{};  ///< sum 1
};

std::vector<Taps> taps(unsigned fine, unsigned coarse) {
    std::vector<Taps> result(coarse);
    const double ratio = static_cast<double>(fine) / coarse;
    for (unsigned i = 0; i < coarse; ++i) {
        const double low = i * ratio;
        const double high = std::min<double>(low + ratio, fine);
        result[i].first = static_cast<unsigned>(low);
        for (unsigned k = 0; k < 4; ++k) {
            const double texel = result[i].first + k;
            const double overlap = std::min(high, texel + 1.) - std::max(low, texel);
            result[i].weights[k] = static_cast<float>(std::max(0., overlap) / ratio);
        }
    }
    return result;
}

/// Weighted mean of texels `step` apart; equal texels give exactly their value.
float average(const float* texel, std::size_t step, const Taps& t) {
    float sum = *texel;
    for (unsigned k = 1; k < 4; ++k) {
        if (t.weights[k] > 0.F) sum += t.weights[k] * (texel[k * step] - *texel);
    }
    return sum;
}

ImageF halved(const ImageF& fine) {
    const unsigned width = (fine.getWidth() + 1) / 2;
    const unsigned height = (fine.getHeight() + 1) / 2;
    const auto columns = taps(fine.getWidth(), width);
    const auto rows = taps(fine.getHeight(), height);
    ImageF narrow(fine.getHeight(), width);
    for (unsigned v = 0; v < fine.getHeight(); ++v) {
        for (unsigned u = 0; u < width; ++u) {
            narrow[v][u] = average(fine[v] + columns[u].first, 1, columns[u]);
        }
    }
    ImageF coarse(height, width);
    for (unsigned v = 0; v < height; ++v) {
        for (unsigned u = 0; u < width; ++u) {
            coarse[v][u] = average(narrow[rows[v].first] + u, width, rows[v]);
        }
    }
    return coarse;
}

std::uint16_t stored(float grey) {
    return static_cast<std::uint16_t>(std::lrint(std::clamp(grey, 0.F, 1.F) * MipTexture::kOne));
}

}  // namespace

MipTexture::MipTexture(const ImageF& image) {
    const float* begin = image.bitmap;
    const float* end = begin + image.getSize();
    if (std::all_of(begin, end, [&](float x) { return x == *begin; })) {
        uniform_ = *begin;
        return;
    }
    append(image);
    findUniformTiles();
    ImageF level = image;
    while (level.getWidth() > 1 || level.getHeight() > 1) {
        level = halved(level);
        append(level);
    }
}

void MipTexture::append(const ImageF& image) {
    const unsigned width = image.getWidth();
    const unsigned height = image.getHeight();
    const auto columns = static_cast<float>(width);
    const auto rows = static_cast<float>(height);
    levels_.push_back(
        {columns, rows, 1.F / columns, 1.F / rows, static_cast<int>(width + 1), texels_.size()});
    texels_.resize(texels_.size() + std::size_t{width + 1} * (height + 1));
    std::uint16_t* out = texels_.data() + levels_.back().start;
    for (unsigned v = 0; v <= height; ++v) {
        const float* row = image[v < height ? v : 0];
        out = std::transform(row, row + width, out, stored);
        *out++ = stored(row[0]);
    }
}

/// Sums over rectangles follow from sums over all tiles to the left and above.
void MipTexture::findUniformTiles() {
    const Level& base = levels_[0];
    tiles_ = (Eigen::Array2i(int(base.width), int(base.height)) + kTile - 1) / kTile;
    rough_.assign(std::size_t((tiles_ + 1).prod()), 0);
    for (int y = 0; y < tiles_.y(); ++y) {
        for (int x = 0; x < tiles_.x(); ++x) {
            const bool isRough = !isUniform(x, y);
            hasUniformTiles_ = hasUniformTiles_ || !isRough;
            rough(x + 1, y + 1) = rough(x + 1, y) + rough(x, y + 1) - rough(x, y) + int{isRough};
        }
    }
}

/// With the column and the row that follow: uniform tiles beside each other are equal.
bool MipTexture::isUniform(int tileX, int tileY) const {
    const Level& base = levels_[0];
    const int right = std::min(kTile * (tileX + 1), int(base.width));
    const int bottom = std::min(kTile * (tileY + 1), int(base.height));
    const std::uint16_t first = texels(0)[kTile * tileY * base.pitch + kTile * tileX];
    for (int v = kTile * tileY; v <= bottom; ++v) {
        const std::uint16_t* row = texels(0) + std::ptrdiff_t{v} * base.pitch;
        const bool isSame = std::all_of(row + kTile * tileX, row + right + 1,
                                        [first](std::uint16_t texel) { return texel == first; });
        if (!isSame) return false;
    }
    return true;
}

std::optional<std::uint16_t> MipTexture::uniformWithin(const Eigen::Array2d& low,
                                                       const Eigen::Array2d& high) const {
    const Eigen::Array2d size(levels_[0].width, levels_[0].height);
    if (!((high - low) < size).all()) return {};
    const Eigen::Array2d repetition = (low / size).floor() * size;
    const Eigen::Array2i first = ((low - repetition) / kTile).cast<int>().min(tiles_ - 1);
    const Eigen::Array2i last = ((high - repetition) / kTile).cast<int>();
    if ((high - repetition >= size).any()) return {};
    const Eigen::Array2i end = last + 1;
    const int count = rough(end.x(), end.y()) - rough(first.x(), end.y()) -
                      rough(end.x(), first.y()) + rough(first.x(), first.y());
    if (count != 0) return {};
    return texels(0)[kTile * first.y() * levels_[0].pitch + kTile * first.x()];
}

}  // namespace photonav
