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

}  // namespace photonav
