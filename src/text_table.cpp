// SPDX-License-Identifier: BSD-3-Clause
#include "text_table.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "error.hpp"

namespace photonav {

double TextRow::number(std::size_t column) const {
    const std::string& field = fields_[column];
    double value = 0.;
    const char* first = field.data() + (field.starts_with('+') ? 1 : 0);
    const auto [end, error] = std::from_chars(first, field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size()) {
        fail(fmt::format("'{}' is not a number", field));
    }
    if (!std::isfinite(value)) fail(fmt::format("'{}' is not a finite number", field));
    return value;
}

void TextRow::fail(const std::string& reason) const {
    throw InputError(file_, fmt::format("line {}", line_), reason);
}

std::vector<TextRow> readTable(const std::string& file, std::size_t columns) {
    std::ifstream in(file);
    if (!in) throw InputError(file, "", "no such file");
    std::vector<TextRow> rows;
    std::string text;
    for (int line = 1; std::getline(in, text); ++line) {
        std::istringstream words(text);
        std::vector<std::string> fields;
        for (std::string word; words >> word;) fields.push_back(word);
        if (fields.empty() || fields[0].starts_with('#')) continue;
        const std::size_t found = fields.size();
        rows.emplace_back(file, line, std::move(fields));
        if (found != columns) {
            rows.back().fail(fmt::format("expected {} fields, found {}", columns, found));
        }
    }
    return rows;
}

}  // namespace photonav
