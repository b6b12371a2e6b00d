#include "gnc/nn/kernels/float_vectors.hpp"
#include "gnc/nn/kernels/pool_256_bit.hpp"
#include "gnc/nn/kernels/row_blocks.hpp"
#include "gnc/nn/kernels/sets.hpp"
#include "gnc/nn/kernels/winograd_tiles.hpp"
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

// Convolution: weights and inputs are widened to 16 bits, the inputs before they are used. A group has four
// products; the sums of its two pairs are kept separately and added at the end.
struct WidenedProduct : Int8Product {
  using Input = std::int16_t;
};
struct Widened {
  using Kind = WidenedProduct;
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
  TUMBLESIGHT_INLINE Values values(const std::int16_t* from) {
    std::int64_t group = 0;
    std::memcpy(&group, from, sizeof group);
    return _mm256_set1_epi64x(group);
  }
  TUMBLESIGHT_INLINE void add(Sums& sum, Values value, const Weights& weight) {
    sum.low = _mm256_add_epi32(sum.low, _mm256_madd_epi16(value, weight.low));
    sum.high = _mm256_add_epi32(sum.high, _mm256_madd_epi16(value, weight.high));
  }
};
// The same with inputs that are widened each time.
struct Int8 : Widened {
  using Kind = Int8Product;
  TUMBLESIGHT_INLINE Values values(const std::uint8_t* from) {
    return _mm256_cvtepu8_epi16(_mm_set1_epi32(group_of(from)));
  }
};

constexpr int kMostWidened = 1024;  // inputs of a strip over a row of pixels
TUMBLESIGHT_INLINE void widen(const std::uint8_t* in, int count, std::int16_t* out) {
  int i = 0;
  for (; i + 16 <= count; i += 16) store_256(_mm256_cvtepu8_epi16(load_128(in + i)), out + i);
  for (; i < count; ++i) out[i] = in[i];
}
TUMBLESIGHT_INLINE int inputs_of_row(const ProductShape& shape) {
  return (shape.columns - 1) * shape.column_step + shape.strip_length;
}
// One row of pixels and one strip at a time, each added to the sums of the strips before.
TUMBLESIGHT_INLINE void convolve_rows(const ProductShape& shape, const std::uint8_t* in,
                                      const std::int32_t* start, const std::int8_t* weights,
                                      std::int32_t* out) {
  alignas(32) std::int16_t widened[kMostWidened];
  ProductShape row = shape;
  row.rows = row.strips = 1;
  for (int y = 0; y < shape.rows; ++y, out += shape.columns * shape.channels) {
    for (int strip = 0; strip < shape.strips; ++strip) {
      widen(in + y * shape.row_step + strip * shape.strip_step, inputs_of_row(shape), widened);
      RowBlocks<Widened>::product<6, 1>(row, widened, strip == 0 ? start : out,
                                        strip == 0 ? 0 : shape.channels,
                                        weights + strip * shape.strip_length * shape.channels, out);
    }
  }
}

void convolve(const ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  if (RowBlocks<Widened>::fit<6, 1>(shape) && inputs_of_row(shape) <= kMostWidened) {
    convolve_rows(shape, in, start, weights, out);
  } else {
    Blocks<Int8>::product<6, 1, 4>(shape, in, start, weights, out);
  }
}

// The first and third input of a group in one vector, the second and fourth in another: 16-bit pairs.
struct Pairs {
  __m256i even, odd;
};
TUMBLESIGHT_INLINE Pairs pairs_of_weights(const std::int8_t* from) {
  const __m256i weights = load_256(from);
  return {_mm256_srai_epi16(_mm256_slli_epi16(weights, 8), 8), _mm256_srai_epi16(weights, 8)};
}

// For the first layer, whose sums are short: no partial sums have to be added at the end. 16 channels; all
// weights and inputs are widened before they are used.
struct WidenedPairs {
  using Input = std::int16_t;
  using Weight = std::int16_t;
  struct Weights {
    Pairs low, high;  // channels 0..7 and 8..15
  };
  struct Values {
    __m256i even, odd;
  };
  TUMBLESIGHT_INLINE Weights weights(const std::int16_t* from) {
    return {{load_256(from), load_256(from + 16)}, {load_256(from + 32), load_256(from + 48)}};
  }
  TUMBLESIGHT_INLINE Values values(const std::int16_t* from) {
    return {_mm256_set1_epi32(group_of(from)), _mm256_set1_epi32(group_of(from + 2))};
  }
  TUMBLESIGHT_INLINE void add(Pool256Bit::Sums& sum, const Values& value, const Weights& weight) {
    sum.low = _mm256_add_epi32(sum.low, _mm256_madd_epi16(value.even, weight.low.even));
    sum.high = _mm256_add_epi32(sum.high, _mm256_madd_epi16(value.even, weight.high.even));
    sum.low = _mm256_add_epi32(sum.low, _mm256_madd_epi16(value.odd, weight.low.odd));
    sum.high = _mm256_add_epi32(sum.high, _mm256_madd_epi16(value.odd, weight.high.odd));
  }
};
using Windows = PooledWindows<Pool256Bit>;
constexpr int kGroupsOfWindow = 9;  // of an image of four channels

// The weights of 16 channels.
TUMBLESIGHT_INLINE void widen_weights(const std::int8_t* weights, int weight_step, std::int16_t* out) {
  for (int group = 0; group < kGroupsOfWindow; ++group, weights += weight_step) {
    for (int half = 0; half < 2; ++half, out += 32) {
      const Pairs pairs = pairs_of_weights(weights + 32 * half);
      store_256(pairs.even, out);
      store_256(pairs.odd, out + 16);
    }
  }
}
// Inputs in the order of WidenedPairs.
TUMBLESIGHT_INLINE void widen_pairs(const std::uint8_t* in, int count, std::int16_t* out) {
  const __m256i kOrder = _mm256_setr_epi8(0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15, 0, 1, 4, 5, 2,
                                          3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15);
  for (int i = 0; i < count; i += 16)
    store_256(_mm256_shuffle_epi8(_mm256_cvtepu8_epi16(load_128(in + i)), kOrder), out + i);
}

void convolve_and_pool(const ImageShape& shape, const std::uint8_t* in, const std::int32_t* start,
                       const std::int8_t* weights, const std::uint8_t* shift, std::uint8_t* out, int out_row,
                       std::int32_t* scratch) {
  constexpr int kWeights = kGroupsOfWindow * Windows::kWidth * Windows::kGroup;
  auto* const widened_weights = reinterpret_cast<std::int16_t*>(scratch);
  std::int16_t* const widened = widened_weights + kWeights;
  for (int c = 0; c < shape.channels_out; c += Windows::kWidth) {
    widen_weights(weights + c * Windows::kGroup, shape.channels_out * Windows::kGroup, widened_weights);
    for (int y = 0; y < shape.side / 2; ++y) {
      widen_pairs(in + 2 * y * shape.row(), 4 * shape.row(), widened);
      Windows::convolve_row<WidenedPairs, 1>(shape, widened, start + c, widened_weights,
                                             Windows::kWidth * Windows::kGroup, shift + c,
                                             out + y * out_row + c);
    }
  }
}
struct WinogradOps {
  using Vector = __m256i;
  using Pool = Pool256Bit;
  static constexpr int kLanes = 8, kTiles = 3, kPooled = 2;
  TUMBLESIGHT_INLINE Vector load(const void* from) { return load_256(from); }
  TUMBLESIGHT_INLINE void store(Vector a, void* to) { store_256(a, to); }
  TUMBLESIGHT_INLINE Vector zero() { return _mm256_setzero_si256(); }
  TUMBLESIGHT_INLINE Vector broadcast(const std::int32_t* from) { return _mm256_set1_epi32(*from); }
  TUMBLESIGHT_INLINE Vector add_16(Vector a, Vector b) { return _mm256_add_epi16(a, b); }
  TUMBLESIGHT_INLINE Vector sub_16(Vector a, Vector b) { return _mm256_sub_epi16(a, b); }
  template <int kBits>
  TUMBLESIGHT_INLINE Vector shift_16(Vector a) {
    return _mm256_slli_epi16(a, kBits);
  }
  TUMBLESIGHT_INLINE Vector add_32(Vector a, Vector b) { return _mm256_add_epi32(a, b); }
  TUMBLESIGHT_INLINE Vector sub_32(Vector a, Vector b) { return _mm256_sub_epi32(a, b); }
  TUMBLESIGHT_INLINE Vector max_32(Vector a, Vector b) { return _mm256_max_epi32(a, b); }
  template <int kBits>
  TUMBLESIGHT_INLINE Vector shift_32(Vector a) {
    return _mm256_slli_epi32(a, kBits);
  }
  template <int kBits>
  TUMBLESIGHT_INLINE Vector divide(Vector a) {
    return _mm256_srai_epi32(a, kBits);
  }
  TUMBLESIGHT_INLINE Vector multiply_32(Vector a, std::int32_t b) {
    return _mm256_mullo_epi32(a, _mm256_set1_epi32(b));
  }
  template <int kOdd>
  TUMBLESIGHT_INLINE Vector widen(Vector bytes) {
    return _mm256_srai_epi16(kOdd == 1 ? bytes : _mm256_slli_epi16(bytes, 8), 8);
  }
  TUMBLESIGHT_INLINE void multiply_add(Vector& sum, Vector a, Vector b) {
    sum = _mm256_add_epi32(sum, _mm256_madd_epi16(a, b));
  }
  TUMBLESIGHT_INLINE Pool::Sums sums(const Vector* vectors) { return {vectors[0], vectors[1]}; }
};
using Tiles = WinogradTiles<WinogradOps>;

MaxPooledConvolution<FixedPoint>* max_pooled_convolution(const ImageShape& shape) {
  if (Windows::fits(shape)) return convolve_and_pool;
  return Tiles::fits(shape) ? Tiles::convolve : nullptr;
}

void multiply(const ProductShape& shape, const std::int16_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  Blocks<Int16>::product<4, 2, 8>(shape, in, start, weights, out);
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

const Kernels<FixedPoint> kFixedAvx2{
    InstructionSet::kAvx2,  6,       convolve, multiply, max_pool, average_pool,
    max_pooled_convolution, nullptr, true};

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
