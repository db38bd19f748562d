// SPDX-License-Identifier: BSD-3-Clause
// Panels in rows with a title and a legend, as PNG, SVG or PDF.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "plot/plot.hpp"

namespace photonav {

struct Figure {
    enum class Legend { above, right, none };

    std::string title = {};
    std::vector<std::vector<Plot>> rows = {};  ///< frames of a column, and of a row, are aligned
    Legend legend = Legend::above;             ///< the topmost mark of a panel first

    // The bytes of a file. @throws std::invalid_argument without panels
    std::string png() const;
    std::string svg() const;
    std::string pdf() const;

    /// Its pixels. @throws std::invalid_argument without panels
    Picture picture() const;

    /// Writes .png, .svg or .pdf.
    /// @throws InputError if the name ends otherwise, or the file cannot be written
    void save(const std::filesystem::path& file) const;
};

}  // namespace photonav
