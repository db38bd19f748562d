// SPDX-License-Identifier: BSD-3-Clause
// Colour pictures.
#pragma once

#include <string>
#include <vector>

#include "plot/color.hpp"

namespace photonav {

using Png = std::string;  ///< the content of a PNG file

struct Picture {
    std::vector<Color> pixels;  ///< row by row, top row first
    int columns = 0;

    int rows() const { return columns > 0 ? static_cast<int>(pixels.size()) / columns : 0; }
};

/// A picture as a PNG file of the same size.
Png pngOf(const Picture& picture);

}  // namespace photonav
