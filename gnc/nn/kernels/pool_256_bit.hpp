// Pooling of 16 channels with AVX2, for PooledWindows.
#pragma once

#include "gnc/nn/kernels/pooled_windows.hpp"
#include "gnc/nn/kernels/x86_vectors.hpp"

namespace tumblesight::gnc {
namespace {

struct Pool256Bit {
  struct Sums {
    __m256i low, high;  // channels 0..7 and 8..15
  };
  struct Rounding {
    Sums half, shift;
  };
  TUMBLESIGHT_INLINE Sums load(const std::int32_t* from) { return {load_256(from), load_256(from + 8)}; }
  TUMBLESIGHT_INLINE Sums max(const Sums& a, const Sums& b) {
    return {_mm256_max_epi32(a.low, b.low), _mm256_max_epi32(a.high, b.high)};
  }
  TUMBLESIGHT_INLINE Sums add(const Sums& a, const Sums& b) {
    return {_mm256_add_epi32(a.low, b.low), _mm256_add_epi32(a.high, b.high)};
  }
  TUMBLESIGHT_INLINE Rounding rounding(const std::uint8_t* from) {
    const __m128i bytes = load_128(from);
    const Sums shift{_mm256_cvtepu8_epi32(bytes), _mm256_cvtepu8_epi32(_mm_srli_si128(bytes, 8))};
    const __m256i one = _mm256_set1_epi32(1);
    return {{_mm256_sllv_epi32(one, _mm256_sub_epi32(shift.low, one)),
             _mm256_sllv_epi32(one, _mm256_sub_epi32(shift.high, one))},
            shift};
  }
  TUMBLESIGHT_INLINE Sums requantize(const Sums& sums, const Rounding& rounding) {
    const Sums rounded = add(sums, rounding.half);
    return {_mm256_srav_epi32(rounded.low, rounding.shift.low),
            _mm256_srav_epi32(rounded.high, rounding.shift.high)};
  }
  TUMBLESIGHT_INLINE Sums limit(const Sums& sums, std::int32_t largest) {
    const __m256i zero = _mm256_setzero_si256(), most = _mm256_set1_epi32(largest);
    return {_mm256_min_epi32(_mm256_max_epi32(sums.low, zero), most),
            _mm256_min_epi32(_mm256_max_epi32(sums.high, zero), most)};
  }
  TUMBLESIGHT_INLINE __m256i to_16_bits(const Sums& sums) {
    constexpr int kLanesInOrder = 0xD8;
    return _mm256_permute4x64_epi64(_mm256_packs_epi32(sums.low, sums.high), kLanesInOrder);
  }
  TUMBLESIGHT_INLINE void store(const Sums& sums, std::uint8_t* to) {
    const __m256i words = to_16_bits(sums);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to),
                     _mm_packus_epi16(_mm256_castsi256_si128(words), _mm256_extracti128_si256(words, 1)));
  }
  TUMBLESIGHT_INLINE void store(const Sums& sums, std::int16_t* to) { store_256(to_16_bits(sums), to); }
};

}  // namespace
}  // namespace tumblesight::gnc
