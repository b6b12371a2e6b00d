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

void convolve(const ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  if (Blocks<Int8>::is_narrow<5, 2, 4>(shape)) {
    Blocks<Int8>::narrow_product<5, 2, 4>(shape, in, start, weights, out);
  } else {
    Blocks<Int8>::product<6, 2, 8>(shape, in, start, weights, out);
  }
}
void multiply(const ProductShape& shape, const std::int16_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  Blocks<Int16>::product<6, 2, 8>(shape, in, start, weights, out);
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

const Kernels<FixedPoint> kFixedAvxVnni{
    InstructionSet::kAvxVnni, 6, convolve, multiply, max_pool, average_pool};

}  // namespace tumblesight::gnc::kernels
