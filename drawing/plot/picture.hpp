// SPDX-License-Identifier: BSD-3-Clause
// Pixels in colour.
#pragma once

#include <string>
#include <vector>

#include "plot/color.hpp"

namespace photonav {

using Png = std::string;  ///< the bytes of a PNG file

struct Picture {
    std::vector<Color> pixels;  ///< row by row, the top one first
    int columns = 0;

    int rows() const { return columns > 0 ? static_cast<int>(pixels.size()) / columns : 0; }
};

/// Pixel by pixel, without a frame.
Png pngOf(const Picture& picture);

}  // namespace photonav
