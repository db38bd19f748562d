// SPDX-License-Identifier: BSD-3-Clause
#include "io/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "io/error.hpp"
#include "io/number.hpp"
#include "io/reading.hpp"

namespace photonav {

double TextRow::number(std::size_t column) const {
    const std::string& field = fields_[column];
    const std::optional<double> value = numberIn(field);
    if (!value) fail(fmt::format("'{}' is not a number", field));
    if (!std::isfinite(*value)) fail(fmt::format("'{}' is not a finite number", field));
    return *value;
}

double TextRow::time(std::size_t column, double unit) const {
    constexpr double kFarthest = 1e10;
    const double time = unit * number(column);
    if (std::abs(time) <= kFarthest) return time;
    fail(fmt::format("timestamp {:g} s is beyond {:g} s; is it in another unit?", time, kFarthest));
}

InputError TextRow::error(const std::string& reason) const {
    return {file_, fmt::format("line {}", line_), reason};
}

namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

std::vector<std::string> splitAtBlanks(std::string_view text) {
    std::vector<std::string> fields;
    for (;;) {
        const std::size_t begin = text.find_first_not_of(kBlanks);
        if (begin == std::string_view::npos) return fields;
        text.remove_prefix(begin);
        const std::size_t end = std::min(text.find_first_of(kBlanks), text.size());
        fields.emplace_back(text.substr(0, end));
        text.remove_prefix(end);
    }
}

template <class Split>
std::vector<TextRow> readRows(const std::string& file, const Split& split, std::size_t least,
                              std::size_t most, std::vector<InputError>* badRows) {
    std::ifstream in = openText(file);
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

std::vector<std::string> splitAtCommas(std::string_view text) {
    std::vector<std::string> fields;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(','), text.size());
        fields.push_back(fmt::format("{}", fmt::join(splitAtBlanks(text.substr(0, end)), " ")));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (fields.size() == 1 && fields[0].empty()) fields.clear();
    return fields;
}

std::ifstream openText(const std::string& file) {
    constexpr std::string_view kMark = "\xEF\xBB\xBF";
    std::ifstream stream = openToRead(file);
    std::array<char, 1000> start{};
    stream.read(start.data(), start.size());
    const std::string_view read(start.data(), static_cast<std::size_t>(stream.gcount()));
    if (read.find('\0') != std::string_view::npos) {
        throw InputError(file, "", "binary or UTF-16, expected plain text");
    }
    stream.clear();
    stream.seekg(read.starts_with(kMark) ? kMark.size() : 0);
    return stream;
}

std::vector<TextRow> readTable(const std::string& file, std::size_t columns,
                               std::vector<InputError>* badRows) {
    return readRows(file, splitAtBlanks, columns, columns, badRows);
}

std::vector<TextRow> readCsv(const std::string& file, std::size_t leastColumns,
                             std::vector<InputError>* badRows) {
    return readRows(file, splitAtCommas, leastColumns, std::string::npos, badRows);
}

}  // namespace photonav
