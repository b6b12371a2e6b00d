#include "gnc/nn/kernels/sets.hpp"
#include "gnc/nn/kernels/x86_vectors.hpp"

namespace tumblesight::gnc::kernels {
namespace {

struct Vnni {
  static constexpr int kWidth = 16;
  using Sums = __m512i;
  using Weights = __m512i;
  using Values = __m512i;
  TUMBLESIGHT_INLINE Sums load(const std::int32_t* from) { return _mm512_loadu_si512(from); }
  TUMBLESIGHT_INLINE void store(Sums sum, std::int32_t* to) { _mm512_storeu_si512(to, sum); }
};
struct Int8 : Vnni {
  using Kind = Int8Product;
  TUMBLESIGHT_INLINE Weights weights(const std::int8_t* from) { return _mm512_loadu_si512(from); }
  TUMBLESIGHT_INLINE Values values(const std::uint8_t* from) { return _mm512_set1_epi32(group_of(from)); }
  TUMBLESIGHT_INLINE void add(Sums& sum, Values value, Weights weight) {
    sum = _mm512_dpbusd_epi32(sum, value, weight);
  }
};
struct Int16 : Vnni {
  using Kind = Int16Product;
  TUMBLESIGHT_INLINE Weights weights(const std::int8_t* from) { return _mm512_cvtepi8_epi16(load_256(from)); }
  TUMBLESIGHT_INLINE Values values(const std::int16_t* from) { return _mm512_set1_epi32(group_of(from)); }
  TUMBLESIGHT_INLINE void add(Sums& sum, Values value, Weights weight) {
    sum = _mm512_dpwssd_epi32(sum, value, weight);
  }
};

void convolve(const ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  if (Blocks<Int8>::is_narrow<25, 1, 4>(shape)) {
    Blocks<Int8>::narrow_product<25, 1, 4>(shape, in, start, weights, out);
  } else if (shape.channels % 64 == 0) {
    Blocks<Int8>::product<6, 4, 8>(shape, in, start, weights, out);
  } else if (shape.channels % 48 == 0) {
    Blocks<Int8>::product<6, 3, 6>(shape, in, start, weights, out);
  } else {
    Blocks<Int8>::product<12, 2, 8>(shape, in, start, weights, out);
  }
}
void multiply(const ProductShape& shape, const std::int16_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  Blocks<Int16>::product<6, 4, 12>(shape, in, start, weights, out);
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

const Kernels<FixedPoint> kFixedAvx512Vnni{
    InstructionSet::kAvx512Vnni, 6, convolve, multiply, max_pool, average_pool};

}  // namespace tumblesight::gnc::kernels
