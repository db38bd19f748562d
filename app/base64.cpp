// SPDX-License-Identifier: BSD-3-Clause
#include "base64.hpp"

#include <array>
#include <cstdint>
#include <stdexcept>

namespace photonav {
namespace {

constexpr std::string_view kAlphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<std::int8_t, 256> makeDecodingTable() {
    std::array<std::int8_t, 256> table{};
    table.fill(-1);
    for (std::size_t i = 0; i < kAlphabet.size(); ++i)
        table[static_cast<unsigned char>(kAlphabet[i])] = static_cast<std::int8_t>(i);
    return table;
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
    static constexpr auto kTable = makeDecodingTable();
    if (text.size() % 4 != 0) throw std::invalid_argument("base64: length not a multiple of 4");
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3);
    while (!text.empty()) {
        const bool last = text.size() == 4;
        const std::size_t digits = !last || text[3] != '=' ? 4 : text[2] != '=' ? 3 : 2;
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const int digit = k < digits ? kTable[static_cast<unsigned char>(text[k])] : 0;
            if (digit < 0) throw std::invalid_argument("base64: character outside the alphabet");
            group = group << 6 | static_cast<std::uint32_t>(digit);
        }
        for (std::size_t k = 0; k + 1 < digits; ++k)
            bytes += static_cast<char>(group >> (16 - 8 * k) & 255U);
        text.remove_prefix(4);
    }
    return bytes;
}

}  // namespace photonav
