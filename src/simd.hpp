// SPDX-License-Identifier: BSD-3-Clause
// Short vectors of the width the target offers, as GCC vector extensions: arithmetic and
// comparisons are the language's own operators; this adds the few that are missing.
#pragma once

#include <cstdint>

namespace photonav::simd {

#if defined(__AVX512F__)
inline constexpr int kWidth = 16;
#elif defined(__AVX2__)
inline constexpr int kWidth = 8;
#else
inline constexpr int kWidth = 4;
#endif

using Float [[gnu::vector_size(kWidth * 4)]] = float;
using Int [[gnu::vector_size(kWidth * 4)]] = std::int32_t;  // also masks: -1 true, 0 false

}  // namespace photonav::simd
