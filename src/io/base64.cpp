// SPDX-License-Identifier: BSD-3-Clause
#include "io/base64.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

namespace photonav {
namespace {

constexpr std::string_view kAlphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::uint32_t valueOf(char character) {
    const std::size_t value = kAlphabet.find(character);
    if (value == std::string_view::npos) throw std::invalid_argument("not base64");
    return static_cast<std::uint32_t>(value);
}

}  // namespace

std::string base64Encode(std::string_view bytes) {
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= count ? kAlphabet[group >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

std::string base64Decode(std::string_view text) {
    if (text.size() % 4 != 0) throw std::invalid_argument("not base64: cut short");
    const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3);
    for (std::size_t i = 0; i < text.size(); i += 4) {
        const std::size_t count = i + 4 == text.size() ? 4 - padding : 4;
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 4; ++k)
            group = group << 6 | (k < count ? valueOf(text[i + k]) : 0U);
        for (std::size_t k = 1; k < count; ++k)
            bytes += static_cast<char>(group >> (24 - 8 * k) & 255U);
    }
    return bytes;
}

}  // namespace photonav
