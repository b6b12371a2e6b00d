#include "gnc/nn/kernels/pool_256_bit.hpp"
#include "gnc/nn/kernels/row_blocks.hpp"
#include "gnc/nn/kernels/sets.hpp"
#include "gnc/nn/kernels/x86_vectors.hpp"

namespace tumblesight::gnc::kernels {
namespace {

struct Vnni {
  static constexpr int kWidth = 8;
  using Sums = __m256i;
  using Weights = __m256i;
  using Values = __m256i;
  TUMBLESIGHT_INLINE Sums load(const std::int32_t* from) { return load_256(from); }
  TUMBLESIGHT_INLINE void store(Sums sum, std::int32_t* to) { store_256(sum, to); }
};
struct Int8 : Vnni {
  using Kind = Int8Product;
  TUMBLESIGHT_INLINE Weights weights(const std::int8_t* from) { return load_256(from); }
  TUMBLESIGHT_INLINE Values values(const std::uint8_t* from) { return _mm256_set1_epi32(group_of(from)); }
  TUMBLESIGHT_INLINE void add(Sums& sum, Values value, Weights weight) {
    sum = _mm256_dpbusd_avx_epi32(sum, value, weight);
  }
};
struct Int16 : Vnni {
  using Kind = Int16Product;
  TUMBLESIGHT_INLINE Weights weights(const std::int8_t* from) { return _mm256_cvtepi8_epi16(load_128(from)); }
  TUMBLESIGHT_INLINE Values values(const std::int16_t* from) { return _mm256_set1_epi32(group_of(from)); }
  TUMBLESIGHT_INLINE void add(Sums& sum, Values value, Weights weight) {
    sum = _mm256_dpwssd_avx_epi32(sum, value, weight);
  }
};

// 16 channels.
struct Int8Pair {
  using Input = std::uint8_t;
  using Weight = std::int8_t;
  using Weights = Pool256Bit::Sums;
  TUMBLESIGHT_INLINE Weights weights(const std::int8_t* from) {
    return {load_256(from), load_256(from + 32)};
  }
  TUMBLESIGHT_INLINE __m256i values(const std::uint8_t* from) { return Int8::values(from); }
  TUMBLESIGHT_INLINE void add(Pool256Bit::Sums& sum, __m256i value, const Weights& weight) {
    Int8::add(sum.low, value, weight.low);
    Int8::add(sum.high, value, weight.high);
  }
};
using Windows = PooledWindows<Pool256Bit>;

void convolve(const ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  if (RowBlocks<Int8>::fit<6, 2>(shape)) {
    RowBlocks<Int8>::product<6, 2>(shape, in, start, 0, weights, out);
  } else {
    Blocks<Int8>::product<6, 2, 8>(shape, in, start, weights, out);
  }
}
void convolve_and_pool(const ImageShape& shape, const std::uint8_t* in, const std::int32_t* start,
                       const std::int8_t* weights, const std::uint8_t* shift, std::uint8_t* out, int out_row,
                       std::int32_t*) {
  Windows::convolve<Int8Pair, 1>(shape, in, start, weights, shift, out, out_row);
}
MaxPooledConvolution<FixedPoint>* max_pooled_convolution(const ImageShape& shape) {
  return Windows::fits(shape) ? convolve_and_pool : nullptr;
}
void multiply(const ProductShape& shape, const std::int16_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  Blocks<Int16>::product<6, 2, 8>(shape, in, start, weights, out);
}
void max_pool(const std::int32_t* sums, int columns, int channels, const std::uint8_t* shift,
              std::uint8_t* out) {
  Windows::max_pool(sums, columns, channels, shift, out);
}
void average_pool(const std::int32_t* sums, int columns, int channels, const std::uint8_t* shift,
                  std::int16_t* out) {
  Windows::average_pool(sums, columns, channels, shift, out);
}

}  // namespace

const Kernels<FixedPoint> kFixedAvxVnni{
    InstructionSet::kAvxVnni, 6,       convolve, multiply, max_pool, average_pool,
    max_pooled_convolution,   nullptr, true};

}  // namespace tumblesight::gnc::kernels
