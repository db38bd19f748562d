// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace photonav {

/// The number that a text is, with a decimal point whatever the locale says; "nan" and "inf" are
/// numbers. Nothing where something else is before or behind it.
template <typename Number = double>
std::optional<Number> numberIn(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
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

}  // namespace photonav
