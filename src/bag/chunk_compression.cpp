// SPDX-License-Identifier: BSD-3-Clause
#include "bag/chunk_compression.hpp"

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>

namespace photonav {
namespace {

constexpr std::size_t kPiece = 1U << 16U;

/// Calls next(piece) -> bytes in it, until that is 0. A size that is only claimed costs no memory.
template <typename Next>
std::vector<std::uint8_t> inPieces(std::uint32_t size, const Next& next) {
    std::vector<std::uint8_t> result;
    std::array<std::uint8_t, kPiece> piece{};
    while (const std::size_t count = next(piece)) {
        if (count > size - result.size()) throw std::runtime_error("damaged: a chunk is too long");
        result.insert(result.end(), piece.begin(), piece.begin() + std::ptrdiff_t(count));
    }
    return result;
}

std::vector<std::uint8_t> fromBz2(std::span<const std::uint8_t> compressed, std::uint32_t size) {
    bz_stream stream{};
    if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
    const std::unique_ptr<bz_stream, int (*)(bz_stream*)> end(&stream, BZ2_bzDecompressEnd);
    std::vector<std::uint8_t> input(compressed.begin(),
                                    compressed.end());  // the library takes it as not const
    stream.next_in = reinterpret_cast<char*>(input.data());
    stream.avail_in = static_cast<unsigned>(input.size());
    int status = BZ_OK;
    return inPieces(size, [&](auto& piece) -> std::size_t {
        if (status == BZ_STREAM_END) return 0;
        stream.next_out = reinterpret_cast<char*>(piece.data());
        stream.avail_out = kPiece;
        status = BZ2_bzDecompress(&stream);
        if (status != BZ_OK && status != BZ_STREAM_END) {
            throw std::runtime_error("damaged: a chunk is not bz2");
        }
        return kPiece - stream.avail_out;
    });
}

std::vector<std::uint8_t> fromLz4(std::span<const std::uint8_t> compressed, std::uint32_t size) {
    LZ4F_dctx* context = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0U) {
        throw std::bad_alloc();
    }
    const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> end(
        context, LZ4F_freeDecompressionContext);
    std::size_t used = 0, hint = 1;
    return inPieces(size, [&](auto& piece) -> std::size_t {
        while (hint != 0) {
            std::size_t count = kPiece, taken = compressed.size() - used;
            hint = LZ4F_decompress(context, piece.data(), &count, compressed.data() + used, &taken,
                                   nullptr);
            used += taken;
            if (LZ4F_isError(hint) != 0U || (count == 0 && taken == 0)) {
                throw std::runtime_error("damaged: a chunk is not lz4");
            }
            if (count > 0) return count;
        }
        return 0;
    });
}

}  // namespace

std::vector<std::uint8_t> uncompressed(const std::string& compression,
                                       std::span<const std::uint8_t> compressed,
                                       std::uint32_t size) {
    if (size > kLargestChunk) {
        throw std::runtime_error(fmt::format("a chunk of {} bytes is too large", size));
    }
    std::vector<std::uint8_t> result;
    if (compression == "none") {
        result.assign(compressed.begin(), compressed.end());
    } else if (compression == "bz2") {
        result = fromBz2(compressed, size);
    } else if (compression == "lz4") {
        result = fromLz4(compressed, size);
    } else {
        throw std::runtime_error(
            fmt::format("compression '{}' is not one of none, bz2, lz4", compression));
    }
    if (result.size() != size) {
        throw std::runtime_error("damaged: a chunk is not as long as it should be");
    }
    return result;
}

}  // namespace photonav
