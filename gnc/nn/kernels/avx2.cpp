#include "gnc/nn/kernels/float_vectors.hpp"
#include "gnc/nn/kernels/sets.hpp"
#include "gnc/nn/kernels/x86_vectors.hpp"

namespace tumblesight::gnc::kernels {
namespace {

// Dense layers: the weights are widened to 16 bits and multiplied in pairs.
struct Int16 {
  using Kind = Int16Product;
  static constexpr int kWidth = 8;
  using Sums = __m256i;
  using Weights = __m256i;
  using Values = __m256i;
  TUMBLESIGHT_INLINE Sums load(const std::int32_t* from) { return load_256(from); }
  TUMBLESIGHT_INLINE void store(Sums sum, std::int32_t* to) { store_256(sum, to); }
  TUMBLESIGHT_INLINE Weights weights(const std::int8_t* from) { return _mm256_cvtepi8_epi16(load_128(from)); }
  TUMBLESIGHT_INLINE Values values(const std::int16_t* from) { return _mm256_set1_epi32(group_of(from)); }
  TUMBLESIGHT_INLINE void add(Sums& sum, Values value, Weights weight) {
    sum = _mm256_add_epi32(sum, _mm256_madd_epi16(value, weight));
  }
};

// Convolution: weights and inputs are widened to 16 bits. A group has four products; the sums of its two
// pairs are kept separately and added at the end.
struct Int8 {
  using Kind = Int8Product;
  static constexpr int kWidth = 8;
  struct Sums {
    __m256i low, high;  // channels 0..3 and 4..7, two partial sums each
  };
  using Weights = Sums;
  using Values = __m256i;
  TUMBLESIGHT_INLINE Sums load(const std::int32_t* from) {
    return {_mm256_cvtepu32_epi64(load_128(from)), _mm256_cvtepu32_epi64(load_128(from + 4))};
  }
  TUMBLESIGHT_INLINE void store(const Sums& sum, std::int32_t* to) {
    constexpr int kLanesInOrder = 0xD8;
    store_256(_mm256_permute4x64_epi64(_mm256_hadd_epi32(sum.low, sum.high), kLanesInOrder), to);
  }
  TUMBLESIGHT_INLINE Weights weights(const std::int8_t* from) {
    return {_mm256_cvtepi8_epi16(load_128(from)), _mm256_cvtepi8_epi16(load_128(from + 16))};
  }
  TUMBLESIGHT_INLINE Values values(const std::uint8_t* from) {
    return _mm256_cvtepu8_epi16(_mm_set1_epi32(group_of(from)));
  }
  TUMBLESIGHT_INLINE void add(Sums& sum, Values value, const Weights& weight) {
    sum.low = _mm256_add_epi32(sum.low, _mm256_madd_epi16(value, weight.low));
    sum.high = _mm256_add_epi32(sum.high, _mm256_madd_epi16(value, weight.high));
  }
};

void convolve(const ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  if (Blocks<Int8>::is_narrow<5, 1, 4>(shape)) {
    Blocks<Int8>::narrow_product<5, 1, 4>(shape, in, start, weights, out);
  } else {
    Blocks<Int8>::product<6, 1, 4>(shape, in, start, weights, out);
  }
}
void multiply(const ProductShape& shape, const std::int16_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  Blocks<Int16>::product<4, 2, 8>(shape, in, start, weights, out);
}
void max_pool(const std::int32_t* sums, int columns, int channels, const std::uint8_t* shift,
              std::uint8_t* out) {
  pool<FixedPoint, MaxPooling<FixedPoint>>(sums, columns, channels, shift, out);
}
void average_pool(const std::int32_t* sums, int columns, int channels, const std::uint8_t* shift,
                  std::int16_t* out) {
  pool<FixedPoint, AveragePooling<FixedPoint>>(sums, columns, channels, shift, out);
}

}  // namespace

const Kernels<FixedPoint> kFixedAvx2{InstructionSet::kAvx2, 6, convolve, multiply, max_pool, average_pool};

#if TUMBLESIGHT_FLOAT32
namespace {
void float_multiply(const ProductShape& shape, const float* in, const float* start, const float* weights,
                    float* out) {
  float_product<8, 6, 2, 8>(shape, in, start, weights, out);
}
void float_max_pool(const float* sums, int columns, int channels, const std::uint8_t* shift, float* out) {
  pool<Float32, MaxPooling<Float32>>(sums, columns, channels, shift, out);
}
void float_average_pool(const float* sums, int columns, int channels, const std::uint8_t* shift, float* out) {
  pool<Float32, AveragePooling<Float32>>(sums, columns, channels, shift, out);
}
}  // namespace
const Kernels<Float32> kFloatAvx2{InstructionSet::kAvx2, 6, float_multiply, float_multiply, float_max_pool,
                                  float_average_pool};
#endif

}  // namespace tumblesight::gnc::kernels
