// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace photonav {

/// Parses a text that consists of a number only. The decimal separator is a point in every locale;
/// "nan" and "inf" are numbers. Returns nothing if the text has anything before or after the
/// number.
template <typename Number = double>
std::optional<Number> numberIn(std::string_view text) {
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool isWhole = error == std::errc{} && end == text.data() + text.size();
    return isWhole ? std::optional(value) : std::nullopt;
}

/// @throws std::invalid_argument unless the text is a number
template <typename Number = double>
Number toNumber(std::string_view text) {
    if (const auto number = numberIn<Number>(text)) return *number;
    throw std::invalid_argument("not a number: '" + std::string(text) + "'");
}

/// Parses a list of numbers with a separator between them; blanks around a number are ignored.
/// Returns nothing unless every field is a finite number.
inline std::optional<std::vector<double>> numbersIn(std::string_view text, char separator) {
    std::vector<double> numbers;
    for (;;) {
        const std::size_t end = text.find(separator);
        std::string_view field = text.substr(0, end);
        while (field.starts_with(' ')) field.remove_prefix(1);
        while (field.ends_with(' ')) field.remove_suffix(1);
        const std::optional<double> number = numberIn(field);
        if (!number || !std::isfinite(*number)) return {};
        numbers.push_back(*number);
        if (end == std::string_view::npos) return numbers;
        text.remove_prefix(end + 1);
    }
}

}  // namespace photonav
