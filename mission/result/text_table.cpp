// SPDX-License-Identifier: BSD-3-Clause
#include "result/text_table.hpp"

#include <algorithm>

namespace photonav {
namespace {

const std::string kGap = "  ";  // between columns of text

std::vector<std::size_t> widthsOf(const TextTable& table) {
    std::vector<std::size_t> widths;
    for (std::size_t column = 0; column < table.head.size(); ++column) {
        std::size_t width = characters(table.head[column]);
        for (const auto& row : table.rows) width = std::max(width, characters(row[column]));
        widths.push_back(width);
    }
    return widths;
}

/// The same rows with some of the columns, the first one always among them.
TextTable columnsOf(const TextTable& table, std::size_t begin, std::size_t end) {
    const auto some = [&](const std::vector<std::string>& cells) {
        std::vector<std::string> own{cells[0]};
        for (std::size_t column = begin; column < end; ++column) own.push_back(cells[column]);
        return own;
    };
    TextTable part{some(table.head), {}};
    for (const auto& row : table.rows) part.rows.push_back(some(row));
    return part;
}

/// Tables whose lines have at most `width` characters; with at least one column besides the first.
std::vector<TextTable> partsOf(const TextTable& table, std::size_t width) {
    const std::vector<std::size_t> widths = widthsOf(table);
    std::vector<TextTable> parts;
    std::size_t begin = 1, used = widths[0];
    for (std::size_t column = 1; column < widths.size(); ++column) {
        const std::size_t own = kGap.size() + widths[column];
        if (column > begin && used + own > width) {
            parts.push_back(columnsOf(table, begin, column));
            begin = column;
            used = widths[0];
        }
        used += own;
    }
    parts.push_back(columnsOf(table, begin, widths.size()));
    return parts;
}

std::string line(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths,
                 const std::string& between) {
    std::string text = cells[0] + std::string(widths[0] - characters(cells[0]), ' ');
    for (std::size_t i = 1; i < cells.size(); ++i) text += between + padded(cells[i], widths[i]);
    return text;
}

}  // namespace

std::size_t characters(const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width) {
    const std::size_t used = characters(text);
    return std::string(width > used ? width - used : 0, ' ') + text;
}

std::string alignedText(const TextTable& table, std::size_t width) {
    std::string text;
    for (const TextTable& part : partsOf(table, width)) {
        const std::vector<std::size_t> widths = widthsOf(part);
        if (!text.empty()) text += '\n';
        text += line(part.head, widths, kGap) + '\n';
        for (const auto& row : part.rows) text += line(row, widths, kGap) + '\n';
    }
    return text;
}

std::string alignedMarkdown(const TextTable& table) {
    const std::vector<std::size_t> widths = widthsOf(table);
    std::string text = "| " + line(table.head, widths, " | ") + " |\n";
    for (std::size_t i = 0; i < widths.size(); ++i) {
        text += '|' + std::string(widths[i] + 1, '-') + (i == 0 ? '-' : ':');
    }
    text += "|\n";
    for (const auto& row : table.rows) text += "| " + line(row, widths, " | ") + " |\n";
    return text;
}

}  // namespace photonav
