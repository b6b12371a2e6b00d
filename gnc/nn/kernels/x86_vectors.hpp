// Loads and stores of integer vectors on x86.
#pragma once

#include <immintrin.h>

#include <cstdint>
#include <cstring>

#include "gnc/nn/kernels/blocks.hpp"

namespace tumblesight::gnc {
namespace {

// The kGroup inputs of one pixel as a 32-bit word.
template <class Input>
TUMBLESIGHT_INLINE std::int32_t group_of(const Input* from) {
  std::int32_t group = 0;
  std::memcpy(&group, from, sizeof group);
  return group;
}

TUMBLESIGHT_INLINE __m128i load_128(const void* from) {
  return _mm_loadu_si128(static_cast<const __m128i*>(from));
}
TUMBLESIGHT_INLINE __m256i load_256(const void* from) {
  return _mm256_loadu_si256(static_cast<const __m256i*>(from));
}
TUMBLESIGHT_INLINE void store_256(__m256i vector, void* to) {
  _mm256_storeu_si256(static_cast<__m256i*>(to), vector);
}

}  // namespace
}  // namespace tumblesight::gnc
