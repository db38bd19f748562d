// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>

namespace photonav {

using ByteSpan = std::span<const std::uint8_t>;

/// Reads numbers and texts in ROS's serialisation: little-endian, texts and lists preceded by their
/// length. Every length is checked against the bytes that are left.
class ByteReader {
  public:
    explicit ByteReader(ByteSpan bytes) : bytes_(bytes) {}

    std::size_t position() const { return position_; }
    bool isAtEnd() const { return position_ == bytes_.size(); }

    /// @throws std::runtime_error when there are fewer left
    ByteSpan bytes(std::size_t count) {
        if (count > bytes_.size() - position_) {
            throw std::runtime_error("damaged: a record or message ends too early");
        }
        position_ += count;
        return bytes_.subspan(position_ - count, count);
    }

    template <typename Number>
    Number number() {
        static_assert(std::endian::native == std::endian::little);
        Number value{};
        std::memcpy(&value, bytes(sizeof(Number)).data(), sizeof(Number));
        return value;
    }

    /// A block of bytes preceded by its length (uint32).
    ByteSpan block() { return bytes(number<std::uint32_t>()); }

    std::string text() {
        const auto block = this->block();
        return {block.begin(), block.end()};
    }

  private:
    ByteSpan bytes_;
    std::size_t position_ = 0;
};

}  // namespace photonav
