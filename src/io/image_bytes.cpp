// SPDX-License-Identifier: BSD-3-Clause
#include "io/image_bytes.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <string_view>

#include "io/error.hpp"
#include "io/reading.hpp"

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

std::uint64_t littleEndian(Bytes four) {
    return std::uint64_t{four[0]} | std::uint64_t{four[1]} << 8 | std::uint64_t{four[2]} << 16 |
           std::uint64_t{four[3]} << 24;
}

std::optional<ImageSize> sizeOfPng(Bytes encoded) {
    if (encoded.size() < 24) return {};
    return ImageSize{bigEndian(encoded.subspan(16, 4)), bigEndian(encoded.subspan(20, 4))};
}

/// Segments: 0xFF, a marker, a length; the one that begins the frame has the size.
std::optional<ImageSize> sizeOfJpeg(Bytes encoded) {
    for (std::size_t at = 2; at + 9 <= encoded.size();) {
        if (encoded[at] != 0xFF) return {};
        const unsigned marker = encoded[at + 1];
        if (marker == 0xFF) {  // padding
            ++at;
            continue;
        }
        if (marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8)) {  // without a length
            at += 2;
            continue;
        }
        const bool isFrame =
            marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
        const auto twoBytes = [&](std::size_t i) {
            return std::uint64_t{encoded[i]} << 8 | encoded[i + 1];
        };
        if (isFrame) return ImageSize{twoBytes(at + 7), twoBytes(at + 5)};
        at += 2 + twoBytes(at + 2);
    }
    return {};
}

/// Width and height are signed; a height below zero begins at the top.
std::optional<ImageSize> sizeOfBmp(Bytes encoded) {
    if (encoded.size() < 26) return {};
    if (littleEndian(encoded.subspan(14, 4)) < 40) return {};  // OS/2's header
    const auto length = [&](std::size_t at) {
        return static_cast<std::uint64_t>(std::abs(
            std::int64_t{static_cast<std::int32_t>(littleEndian(encoded.subspan(at, 4)))}));
    };
    return ImageSize{length(18), length(22)};
}

/// Numbers in text, with comments between them.
std::optional<ImageSize> sizeOfPnm(Bytes encoded) {
    std::array<std::uint64_t, 2> numbers{};
    std::size_t at = 2;
    for (std::uint64_t& number : numbers) {
        while (at < encoded.size() && (std::isspace(encoded[at]) != 0 || encoded[at] == '#')) {
            if (encoded[at] == '#') {
                while (at < encoded.size() && encoded[at] != '\n') ++at;
            } else {
                ++at;
            }
        }
        std::size_t digits = 0;
        for (; at < encoded.size() && std::isdigit(encoded[at]) != 0; ++at, ++digits) {
            number = 10 * number + (encoded[at] - '0');
            if (digits > 9) return {};
        }
        if (digits == 0) return {};
    }
    return ImageSize{numbers[0], numbers[1]};
}

}  // namespace

std::optional<ImageSize> declaredSize(Bytes encoded) {
    if (startsWith(encoded, kPng)) return sizeOfPng(encoded);
    if (startsWith(encoded, kJpeg)) return sizeOfJpeg(encoded);
    if (startsWith(encoded, std::array<std::uint8_t, 2>{'B', 'M'})) return sizeOfBmp(encoded);
    for (const std::uint8_t kind : {'2', '3', '5', '6'}) {
        if (startsWith(encoded, std::array<std::uint8_t, 2>{'P', kind})) return sizeOfPnm(encoded);
    }
    return {};
}

std::vector<std::uint8_t> readBytes(const std::string& file) {
    std::ifstream in = openToRead(file);
    in.seekg(0, std::ios::end);
    const std::streamoff size = in.tellg();
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(std::max<std::streamoff>(0, size)));
    in.seekg(0);
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(in.gcount()));  // it may have been cut since
    return bytes;
}

Bytes soundImage(Bytes encoded, std::vector<std::uint8_t>& rewritten) {
    if (startsWith(encoded, kPng)) return rewritten = soundPng(encoded);
    if (startsWith(encoded, kJpeg)) {
        const Bytes last = encoded.last(std::min<std::size_t>(encoded.size(), 1024));
        if (std::search(last.begin(), last.end(), kJpegEnd.begin(), kJpegEnd.end()) == last.end()) {
            return {};
        }
    }
    return encoded;
}

}  // namespace photonav
