// SPDX-License-Identifier: BSD-3-Clause
#include "io/image_bytes.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "io/error.hpp"

namespace photonav {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kPng{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::array<std::uint8_t, 2> kJpeg{0xFF, 0xD8};
constexpr std::array<std::uint8_t, 2> kJpegEnd{0xFF, 0xD9};

template <std::size_t N>
bool startsWith(Bytes bytes, const std::array<std::uint8_t, N>& start) {
    return bytes.size() >= N && std::equal(start.begin(), start.end(), bytes.begin());
}

std::uint32_t bigEndian(Bytes four) {
    return std::uint32_t{four[0]} << 24 | std::uint32_t{four[1]} << 16 |
           std::uint32_t{four[2]} << 8 | four[3];
}

/// The checksum of PNG (ISO 3309).
std::uint32_t checksum(Bytes bytes) {
    return static_cast<std::uint32_t>(crc32_z(0, bytes.data(), bytes.size()));
}

/// Chunks: length, name, data, checksum of name and data.
std::vector<std::uint8_t> soundPng(Bytes encoded) {
    std::vector<std::uint8_t> kept(kPng.begin(), kPng.end());
    for (std::size_t at = kPng.size(); at + 12 <= encoded.size();) {
        const std::size_t length = bigEndian(encoded.subspan(at, 4));
        if (length > encoded.size() - at - 12) return {};
        if (bigEndian(encoded.subspan(at + 8 + length, 4)) !=
            checksum(encoded.subspan(at + 4, 4 + length))) {
            return {};
        }
        const std::string_view name(reinterpret_cast<const char*>(&encoded[at + 4]), 4);
        const Bytes chunk = encoded.subspan(at, 12 + length);
        for (const char* needed : {"IHDR", "PLTE", "tRNS", "IDAT", "IEND"}) {
            if (name == needed) kept.insert(kept.end(), chunk.begin(), chunk.end());
        }
        if (name == "IEND") return kept;
        at += chunk.size();
    }
    return {};
}

}  // namespace

std::vector<std::uint8_t> readBytes(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in || std::filesystem::is_directory(file)) throw InputError(file, "", "no such file");
    return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::uint8_t> soundImage(Bytes encoded) {
    if (startsWith(encoded, kPng)) return soundPng(encoded);
    if (startsWith(encoded, kJpeg)) {
        const Bytes last = encoded.last(std::min<std::size_t>(encoded.size(), 1024));
        if (std::search(last.begin(), last.end(), kJpegEnd.begin(), kJpegEnd.end()) == last.end()) {
            return {};
        }
    }
    return {encoded.begin(), encoded.end()};
}

}  // namespace photonav
