// SPDX-License-Identifier: BSD-3-Clause
// SIMD vectors of the widest registers of the target, by GCC's vector extensions. Arithmetic and
// comparisons are the operators of the language; this file adds the functions that are missing.
#pragma once

#include <cstdint>
#include <cstring>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

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

inline Float splat(float value) { return Float{} + value; }
inline Int splat(int value) { return Int{} + value; }
inline Float toFloat(const Int& a) { return __builtin_convertvector(a, Float); }
inline Int toInt(const Float& a) { return __builtin_convertvector(a, Int); }  ///< towards zero
inline Float min(const Float& a, const Float& b) { return a < b ? a : b; }
inline Float max(const Float& a, const Float& b) { return a > b ? a : b; }
inline Float abs(const Float& a) { return a < 0.F ? -a : a; }
inline Float clamp(const Float& a, float low, float high) {
    const Float raised = a > low ? a : splat(low);
    return raised < high ? raised : splat(high);
}
inline Int clamp(const Int& a, const Int& low, const Int& high) {
    const Int raised = a > low ? a : low;
    return raised < high ? raised : high;
}

/// The vector (0, 1, 2, ...).
inline Float ramp() {
    Float lanes;
    for (int i = 0; i < kWidth; ++i) lanes[i] = static_cast<float>(i);
    return lanes;
}

/// Sum over the lanes, in double precision.
inline double sum(const Float& a) {
    double total = 0.;
    for (int i = 0; i < kWidth; ++i) total += a[i];
    return total;
}

/// a + b with wrap-around on overflow, because unused lanes may have any value.
inline Int wrappingSum(const Int& a, const Int& b) {
    using Unsigned [[gnu::vector_size(kWidth * 4)]] = std::uint32_t;
    return reinterpret_cast<Int>(reinterpret_cast<Unsigned>(a) + reinterpret_cast<Unsigned>(b));
}

/// The largest integer not above a, for |a| < 2^31; an undefined value otherwise.
inline Int floor(const Float& a) {
    const Int truncated = toInt(a);
    const Int above = toFloat(truncated) > a;
    return wrappingSum(truncated, above);
}

/// The nearest integer, for |a| < 2^22; halves are rounded up or down.
inline Float rounded(const Float& a) {
    constexpr float kMagic = 12582912.F;  // 1.5 * 2^23: the sum has no bits for a fraction
    return (a + kMagic) - kMagic;
}

template <typename Vector, typename T>
Vector load(const T* from) {
    Vector result;
    std::memcpy(&result, from, sizeof(result));
    return result;
}

template <typename Vector, typename T>
void store(T* to, const Vector& vector) {
    std::memcpy(to, &vector, sizeof(vector));
}

/// The mask as bits: bit i is set if lane i of the mask is set.
inline unsigned bits(const Int& mask) {
#if defined(__AVX512F__)
    return _mm512_test_epi32_mask(reinterpret_cast<__m512i>(mask), reinterpret_cast<__m512i>(mask));
#elif defined(__AVX2__)
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
#else
    unsigned result = 0;
    for (int i = 0; i < kWidth; ++i) result |= mask[i] ? 1U << i : 0U;
    return result;
#endif
}

inline constexpr unsigned kAllLanes = (1U << kWidth) - 1U;

inline bool any(const Int& mask) {
#if defined(__AVX512F__)
    return _mm512_test_epi32_mask(reinterpret_cast<__m512i>(mask),
                                  reinterpret_cast<__m512i>(mask)) != 0;
#elif defined(__AVX2__)
    return _mm256_testz_si256(reinterpret_cast<__m256i>(mask), reinterpret_cast<__m256i>(mask)) ==
           0;
#else
    return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
#endif
}

/// The four bytes that begin at base + Scale * index, per lane.
template <int Scale>
inline Int gather(const void* base, const Int& index) {
#if defined(__AVX512F__)
    return reinterpret_cast<Int>(
        _mm512_i32gather_epi32(reinterpret_cast<__m512i>(index), base, Scale));
#elif defined(__AVX2__)
    // One load per lane: on most processors the instruction for all of them takes twice as long.
    const auto lane = [base](std::int64_t i) {
        std::int32_t value = 0;
        std::memcpy(&value, static_cast<const char*>(base) + i * Scale, sizeof(value));
        return value;
    };
    const auto pair = [&](std::int64_t lanes) {
        const auto low = static_cast<std::int32_t>(lanes);
        return _mm_insert_epi32(_mm_cvtsi32_si128(lane(low)), lane(lanes >> 32), 1);
    };
    const auto i = reinterpret_cast<__m256i>(index);
    const __m128i low =
        _mm_unpacklo_epi64(pair(_mm256_extract_epi64(i, 0)), pair(_mm256_extract_epi64(i, 1)));
    const __m128i high =
        _mm_unpacklo_epi64(pair(_mm256_extract_epi64(i, 2)), pair(_mm256_extract_epi64(i, 3)));
    return reinterpret_cast<Int>(_mm256_set_m128i(high, low));
#else
    Int result;
    for (int i = 0; i < kWidth; ++i) {
        std::int32_t lane;
        std::memcpy(&lane, static_cast<const char*>(base) + std::ptrdiff_t(Scale) * index[i], 4);
        result[i] = lane;
    }
    return result;
#endif
}

/// The two words of four bytes that begin at base + 8 * index, per lane.
inline void gatherPairs(const void* base, const Int& index, Int& first, Int& second) {
#if defined(__AVX2__) && !defined(__AVX512F__)
    const auto pair = [base](std::int64_t i) {
        return _mm_loadl_epi64(
            reinterpret_cast<const __m128i*>(static_cast<const char*>(base) + 8 * i));
    };
    const auto lanes = [](__m128i low, __m128i high) { return _mm256_set_m128i(high, low); };
    const auto i = reinterpret_cast<__m256i>(index);
    const std::int64_t i01 = _mm256_extract_epi64(i, 0), i23 = _mm256_extract_epi64(i, 1),
                       i45 = _mm256_extract_epi64(i, 2), i67 = _mm256_extract_epi64(i, 3);
    const auto low = [&](std::int64_t both) { return pair(static_cast<std::int32_t>(both)); };
    const auto high = [&](std::int64_t both) { return pair(both >> 32); };
    const __m256i even =
        _mm256_unpacklo_epi32(lanes(low(i01), low(i45)), lanes(high(i01), high(i45)));
    const __m256i odd =
        _mm256_unpacklo_epi32(lanes(low(i23), low(i67)), lanes(high(i23), high(i67)));
    first = reinterpret_cast<Int>(_mm256_unpacklo_epi64(even, odd));
    second = reinterpret_cast<Int>(_mm256_unpackhi_epi64(even, odd));
#else
    first = gather<8>(base, index);
    second = gather<8>(static_cast<const char*>(base) + 4, index);
#endif
}

}  // namespace photonav::simd
