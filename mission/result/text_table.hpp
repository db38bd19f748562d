// SPDX-License-Identifier: BSD-3-Clause
// Tables of text, for terminals, Markdown files and reports.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace photonav {

/// Rows have as many cells as the head. The first column names the rows.
struct TextTable {
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
};

/// Number of characters of a text in UTF-8: `±` takes two bytes.
std::size_t characters(const std::string& text);

/// Fills a text up with spaces on the left.
std::string padded(const std::string& text, std::size_t width);

/// Columns of equal width, the first one aligned to the left, the others to the right. Columns that
/// do not fit into `width` characters follow below, with the first column again.
std::string alignedText(const TextTable& table, std::size_t width = 80);

/// The same as a table of Markdown, whose source is aligned, too.
std::string alignedMarkdown(const TextTable& table);

}  // namespace photonav
