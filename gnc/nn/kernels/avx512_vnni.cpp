#include "gnc/nn/kernels/pooled_windows.hpp"
#include "gnc/nn/kernels/row_blocks.hpp"
#include "gnc/nn/kernels/sets.hpp"
#include "gnc/nn/kernels/winograd_tiles.hpp"
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
  using Input = std::uint8_t;
  using Weight = std::int8_t;
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

struct Pool {
  using Sums = __m512i;
  struct Rounding {
    __m512i half, shift;
  };
  TUMBLESIGHT_INLINE Sums load(const std::int32_t* from) { return _mm512_loadu_si512(from); }
  TUMBLESIGHT_INLINE Sums max(Sums a, Sums b) { return _mm512_max_epi32(a, b); }
  TUMBLESIGHT_INLINE Sums add(Sums a, Sums b) { return _mm512_add_epi32(a, b); }
  TUMBLESIGHT_INLINE Rounding rounding(const std::uint8_t* from) {
    const __m512i one = _mm512_set1_epi32(1), shift = _mm512_cvtepu8_epi32(load_128(from));
    return {_mm512_sllv_epi32(one, _mm512_sub_epi32(shift, one)), shift};
  }
  TUMBLESIGHT_INLINE Sums requantize(Sums sums, const Rounding& rounding) {
    return _mm512_srav_epi32(_mm512_add_epi32(sums, rounding.half), rounding.shift);
  }
  TUMBLESIGHT_INLINE Sums limit(Sums sums, std::int32_t largest) {
    return _mm512_min_epi32(_mm512_max_epi32(sums, _mm512_setzero_si512()), _mm512_set1_epi32(largest));
  }
  TUMBLESIGHT_INLINE void store(Sums sums, std::uint8_t* to) {
    const __m512i not_negative = _mm512_max_epi32(sums, _mm512_setzero_si512());
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm512_cvtusepi32_epi8(not_negative));
  }
  TUMBLESIGHT_INLINE void store(Sums sums, std::int16_t* to) { store_256(_mm512_cvtepi32_epi16(sums), to); }
};
using Windows = PooledWindows<Pool>;

void convolve(const ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  if (RowBlocks<Int8>::fit<6, 4>(shape)) {
    RowBlocks<Int8>::product<6, 4>(shape, in, start, weights, out);
  } else if (RowBlocks<Int8>::fit<6, 3>(shape)) {
    RowBlocks<Int8>::product<6, 3>(shape, in, start, weights, out);
  } else if (shape.channels % 64 == 0) {
    Blocks<Int8>::product<6, 4, 8>(shape, in, start, weights, out);
  } else if (shape.channels % 48 == 0) {
    Blocks<Int8>::product<6, 3, 6>(shape, in, start, weights, out);
  } else {
    Blocks<Int8>::product<12, 2, 8>(shape, in, start, weights, out);
  }
}
void convolve_and_pool(const ImageShape& shape, const std::uint8_t* in, const std::int32_t* start,
                       const std::int8_t* weights, const std::uint8_t* shift, std::uint8_t* out,
                       int out_row) {
  Windows::convolve<Int8, 2>(shape, in, start, weights, shift, out, out_row);
}
struct WinogradOps {
  using Vector = __m512i;
  using Pool = kernels::Pool;
  static constexpr int kLanes = 16, kTiles = 9, kPooled = 1;
  TUMBLESIGHT_INLINE Vector load(const void* from) { return _mm512_loadu_si512(from); }
  TUMBLESIGHT_INLINE void store(Vector a, void* to) { _mm512_storeu_si512(to, a); }
  TUMBLESIGHT_INLINE Vector zero() { return _mm512_setzero_si512(); }
  TUMBLESIGHT_INLINE Vector broadcast(const std::int32_t* from) { return _mm512_set1_epi32(*from); }
  TUMBLESIGHT_INLINE Vector add_16(Vector a, Vector b) { return _mm512_add_epi16(a, b); }
  TUMBLESIGHT_INLINE Vector sub_16(Vector a, Vector b) { return _mm512_sub_epi16(a, b); }
  template <int kBits>
  TUMBLESIGHT_INLINE Vector shift_16(Vector a) {
    return _mm512_slli_epi16(a, kBits);
  }
  TUMBLESIGHT_INLINE Vector add_32(Vector a, Vector b) { return _mm512_add_epi32(a, b); }
  TUMBLESIGHT_INLINE Vector sub_32(Vector a, Vector b) { return _mm512_sub_epi32(a, b); }
  TUMBLESIGHT_INLINE Vector max_32(Vector a, Vector b) { return _mm512_max_epi32(a, b); }
  template <int kBits>
  TUMBLESIGHT_INLINE Vector shift_32(Vector a) {
    return _mm512_slli_epi32(a, kBits);
  }
  template <int kBits>
  TUMBLESIGHT_INLINE Vector divide(Vector a) {
    return _mm512_srai_epi32(a, kBits);
  }
  TUMBLESIGHT_INLINE Vector multiply_32(Vector a, std::int32_t b) {
    return _mm512_mullo_epi32(a, _mm512_set1_epi32(b));
  }
  template <int kOdd>
  TUMBLESIGHT_INLINE Vector widen(Vector bytes) {
    return _mm512_srai_epi16(kOdd == 1 ? bytes : _mm512_slli_epi16(bytes, 8), 8);
  }
  TUMBLESIGHT_INLINE void multiply_add(Vector& sum, Vector a, Vector b) {
    sum = _mm512_dpwssd_epi32(sum, a, b);
  }
  TUMBLESIGHT_INLINE Pool::Sums sums(const Vector* vectors) { return vectors[0]; }
};
using Tiles = WinogradTiles<WinogradOps>;

PooledConvolution<FixedPoint>* pooled_convolution(const ImageShape& shape) {
  if (Windows::fits(shape)) return convolve_and_pool;
  return Tiles::fits(shape) ? Tiles::convolve : nullptr;
}
void multiply(const ProductShape& shape, const std::int16_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  Blocks<Int16>::product<6, 4, 12>(shape, in, start, weights, out);
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

const Kernels<FixedPoint> kFixedAvx512Vnni{
    InstructionSet::kAvx512Vnni, 6, convolve, multiply, max_pool, average_pool, pooled_convolution, true};

}  // namespace tumblesight::gnc::kernels
