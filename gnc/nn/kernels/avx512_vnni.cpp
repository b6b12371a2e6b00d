#include "gnc/nn/kernels/gate_table.hpp"
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
    RowBlocks<Int8>::product<6, 4>(shape, in, start, 0, weights, out);
  } else if (RowBlocks<Int8>::fit<6, 3>(shape)) {
    RowBlocks<Int8>::product<6, 3>(shape, in, start, 0, weights, out);
  } else if (shape.channels % 64 == 0) {
    Blocks<Int8>::product<6, 4, 8>(shape, in, start, weights, out);
  } else if (shape.channels % 48 == 0) {
    Blocks<Int8>::product<6, 3, 6>(shape, in, start, weights, out);
  } else {
    Blocks<Int8>::product<12, 2, 8>(shape, in, start, weights, out);
  }
}
void convolve_and_pool(const ImageShape& shape, const std::uint8_t* in, const std::int32_t* start,
                       const std::int8_t* weights, const std::uint8_t* shift, std::uint8_t* out, int out_row,
                       std::int32_t*) {
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

MaxPooledConvolution<FixedPoint>* max_pooled_convolution(const ImageShape& shape) {
  if (Windows::fits(shape)) return convolve_and_pool;
  return Tiles::fits(shape) ? Tiles::convolve : nullptr;
}
void multiply(const ProductShape& shape, const std::int16_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  if (shape.channels % 192 == 0) {
    Blocks<Int16>::product<6, 4, 12>(shape, in, start, weights, out);
  } else if (shape.channels % 128 == 0) {
    Blocks<Int16>::product<6, 4, 8>(shape, in, start, weights, out);
  } else {
    Blocks<Int16>::product<6, 4, 4>(shape, in, start, weights, out);
  }
}
void max_pool(const std::int32_t* sums, int columns, int channels, const std::uint8_t* shift,
              std::uint8_t* out) {
  Windows::max_pool(sums, columns, channels, shift, out);
}
void average_pool(const std::int32_t* sums, int columns, int channels, const std::uint8_t* shift,
                  std::int16_t* out) {
  Windows::average_pool(sums, columns, channels, shift, out);
}

// The LSTM, 16 units at a time. Products of Fixed are computed in 64 bits, of the units with an even and an
// odd index separately.
constexpr auto kGateTable = make_gate_table();
constexpr std::int32_t kOne = 1 << Fixed::kFractionBits;

TUMBLESIGHT_INLINE __m512i interleave(__m512i even, __m512i odd) {
  constexpr __mmask16 kOdd = 0xAAAA;
  return _mm512_mask_blend_epi32(kOdd, even, _mm512_slli_epi64(odd, 32));
}
TUMBLESIGHT_INLINE __m512i odd_units(__m512i a) {
  return _mm512_srli_epi64(a, 32);
}
TUMBLESIGHT_INLINE __m512i limit_64(__m512i a, std::int64_t largest) {
  return _mm512_min_epi64(_mm512_max_epi64(a, _mm512_set1_epi64(-largest)), _mm512_set1_epi64(largest));
}
// Output rule: to_real() of numerics.hpp for eight sums.
TUMBLESIGHT_INLINE __m256i to_real_8(__m256i sums, __m128i shift_bytes) {
  const __m512i one = _mm512_set1_epi64(1), shift = _mm512_cvtepu8_epi64(shift_bytes);
  const __m512i raw = _mm512_slli_epi64(_mm512_cvtepi32_epi64(sums), Fixed::kFractionBits);
  const __m512i half = _mm512_sllv_epi64(one, _mm512_sub_epi64(shift, one));
  const __m512i rounded = _mm512_srav_epi64(_mm512_add_epi64(raw, half), shift);
  return _mm512_cvtepi64_epi32(limit_64(rounded, Fixed::kLargestRaw));
}
TUMBLESIGHT_INLINE __m512i gate_value(const std::int32_t* sums, const std::uint8_t* shift) {
  const __m128i shifts = load_128(shift);
  return _mm512_inserti64x4(_mm512_castsi256_si512(to_real_8(load_256(sums), shifts)),
                            to_real_8(load_256(sums + 8), _mm_srli_si128(shifts, 8)), 1);
}
// gate_sigmoid() of lstm.hpp. The product with the position is computed in two parts of 32 bits.
TUMBLESIGHT_INLINE __m512i gate_sigmoids(__m512i x) {
  constexpr int kLowBits = 8;
  const __m512i inside = _mm512_min_epi32(_mm512_abs_epi32(x), _mm512_set1_epi32(kGateEnd - 1));
  const __m512i segment = _mm512_srli_epi32(inside, kGatePositionBits);
  const __m512i position = _mm512_and_si512(inside, _mm512_set1_epi32((1 << kGatePositionBits) - 1));
  const __m512i from = _mm512_i32gather_epi32(segment, kGateTable.data(), 4);
  const __m512i rise = _mm512_sub_epi32(_mm512_i32gather_epi32(segment, kGateTable.data() + 1, 4), from);
  const __m512i low =
      _mm512_mullo_epi32(rise, _mm512_and_si512(position, _mm512_set1_epi32((1 << kLowBits) - 1)));
  const __m512i high = _mm512_mullo_epi32(rise, _mm512_srli_epi32(position, kLowBits));
  const __m512i half = _mm512_set1_epi32(1 << (kGatePositionBits - 1));
  const __m512i scaled = _mm512_add_epi32(high, _mm512_srli_epi32(_mm512_add_epi32(low, half), kLowBits));
  const __m512i above = _mm512_add_epi32(from, _mm512_srli_epi32(scaled, kGatePositionBits - kLowBits));
  const __mmask16 is_negative = _mm512_cmplt_epi32_mask(x, _mm512_setzero_si512());
  return _mm512_mask_sub_epi32(above, is_negative, _mm512_set1_epi32(kOne), above);
}
TUMBLESIGHT_INLINE __m512i gate_tanhs(__m512i x) {
  const __m512i end = _mm512_set1_epi32(kGateEnd);
  const __m512i limited =
      _mm512_max_epi32(_mm512_min_epi32(x, end), _mm512_sub_epi32(_mm512_setzero_si512(), end));
  const __m512i sigmoid = gate_sigmoids(_mm512_add_epi32(limited, limited));
  return _mm512_sub_epi32(_mm512_add_epi32(sigmoid, sigmoid), _mm512_set1_epi32(kOne));
}
// a b + c d of the even units, rounded and limited to the bound of the cells.
TUMBLESIGHT_INLINE __m512i even_cells(__m512i a, __m512i b, __m512i c, __m512i d) {
  constexpr std::int64_t kBound = std::int64_t{64} << Fixed::kFractionBits;  // kLstmCellBound
  const __m512i sum = _mm512_add_epi64(_mm512_mul_epi32(a, b), _mm512_mul_epi32(c, d));
  const __m512i half = _mm512_set1_epi64(kOne / 2);
  return limit_64(_mm512_srai_epi64(_mm512_add_epi64(sum, half), Fixed::kFractionBits), kBound);
}
// a b of the even units in Q0.15.
TUMBLESIGHT_INLINE __m512i even_inputs(__m512i a, __m512i b) {
  constexpr int kShift = 2 * Fixed::kFractionBits - 15;
  const __m512i half = _mm512_set1_epi64(std::int64_t{1} << (kShift - 1));
  return limit_64(_mm512_srai_epi64(_mm512_add_epi64(_mm512_mul_epi32(a, b), half), kShift), 32767);
}
void update_lstm(const std::int32_t* gates, const std::uint8_t* shift, int hidden, std::int16_t* h,
                 Fixed* c) {
  for (int i = 0; i < hidden; i += 16) {
    const __m512i input = gate_sigmoids(gate_value(gates + i, shift + i));
    const __m512i forget = gate_sigmoids(gate_value(gates + hidden + i, shift + hidden + i));
    const __m512i cell = gate_tanhs(gate_value(gates + 2 * hidden + i, shift + 2 * hidden + i));
    const __m512i output = gate_sigmoids(gate_value(gates + 3 * hidden + i, shift + 3 * hidden + i));
    const __m512i before = _mm512_loadu_si512(c + i);
    const __m512i cells =
        interleave(even_cells(forget, before, input, cell),
                   even_cells(odd_units(forget), odd_units(before), odd_units(input), odd_units(cell)));
    _mm512_storeu_si512(c + i, cells);
    const __m512i tanhs = gate_tanhs(cells);
    const __m512i inputs =
        interleave(even_inputs(output, tanhs), even_inputs(odd_units(output), odd_units(tanhs)));
    store_256(_mm512_cvtepi32_epi16(inputs), h + i);
  }
}

}  // namespace

const Kernels<FixedPoint> kFixedAvx512Vnni{
    InstructionSet::kAvx512Vnni, 6,       convolve, multiply,   max_pool, average_pool,
    max_pooled_convolution,      nullptr, true,     update_lstm};

}  // namespace tumblesight::gnc::kernels
