// SPDX-License-Identifier: BSD-3-Clause
// Figures: panels in rows with a title and a legend, as PNG, SVG or PDF.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "plot/plot.hpp"

namespace photonav {

struct Figure {
    enum class Legend { above, right, none };

    std::string title = {};
    std::vector<std::vector<Plot>> rows = {};  ///< frames are aligned in rows and columns
    /// Place of the legend. Entries of marks drawn on top come first.
    Legend legend = Legend::above;

    // The content of a file. @throws std::invalid_argument without panels
    std::string png() const;
    std::string svg() const;
    std::string pdf() const;

    /// The figure as pixels. @throws std::invalid_argument without panels
    Picture picture() const;

    /// Writes a file whose format is given by its ending: .png, .svg or .pdf.
    /// @throws InputError for another ending, and if the file cannot be written
    void save(const std::filesystem::path& file) const;
};

}  // namespace photonav
