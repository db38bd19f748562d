// SPDX-License-Identifier: BSD-3-Clause
#include "io/text_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "io/error.hpp"
#include "io/number.hpp"

namespace photonav {

double TextRow::number(std::size_t column) const {
    const std::string& field = fields_[column];
    const std::optional<double> value = numberIn(field);
    if (!value) fail(fmt::format("'{}' is not a number", field));
    if (!std::isfinite(*value)) fail(fmt::format("'{}' is not a finite number", field));
    return *value;
}

InputError TextRow::error(const std::string& reason) const {
    return {file_, fmt::format("line {}", line_), reason};
}

namespace {

std::vector<std::string> splitAtBlanks(const std::string& text) {
    std::istringstream words(text);
    std::vector<std::string> fields;
    for (std::string word; words >> word;) fields.push_back(word);
    return fields;
}

std::vector<std::string> splitAtCommas(const std::string& text) {
    std::vector<std::string> fields;
    std::istringstream in(text);
    for (std::string field; std::getline(in, field, ',');) {
        const auto words = splitAtBlanks(field);
        fields.push_back(fmt::format("{}", fmt::join(words, " ")));
    }
    if (fields.size() == 1 && fields[0].empty()) fields.clear();
    return fields;
}

template <class Split>
std::vector<TextRow> readRows(const std::string& file, const Split& split, std::size_t least,
                              std::size_t most, std::vector<InputError>* badRows) {
    std::ifstream in(file);
    if (!in) throw InputError(file, "", "no such file");
    std::vector<TextRow> rows;
    std::string text;
    for (int line = 1; std::getline(in, text); ++line) {
        std::vector<std::string> fields = split(text);
        if (fields.empty() || fields[0].starts_with('#')) continue;
        const std::size_t found = fields.size();
        rows.emplace_back(file, line, std::move(fields));
        if (found >= least && found <= most) continue;
        const InputError error =
            rows.back().error(fmt::format("expected {} fields, found {}", least, found));
        if (!badRows) throw error;
        badRows->push_back(error);
        rows.pop_back();
    }
    return rows;
}

}  // namespace

std::vector<TextRow> readTable(const std::string& file, std::size_t columns,
                               std::vector<InputError>* badRows) {
    return readRows(file, splitAtBlanks, columns, columns, badRows);
}

std::vector<TextRow> readCsv(const std::string& file, std::size_t leastColumns,
                             std::vector<InputError>* badRows) {
    return readRows(file, splitAtCommas, leastColumns, std::string::npos, badRows);
}

}  // namespace photonav
