// SPDX-License-Identifier: BSD-3-Clause
#include "io/checksum.hpp"

#include <zlib.h>

namespace photonav {

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) {
    return static_cast<std::uint32_t>(
        ::crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace photonav
