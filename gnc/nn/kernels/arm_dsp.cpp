// Arm's DSP instructions for Cortex-M and Cortex-R: SMLAD adds two 16-bit products to a sum.
#include <arm_acle.h>

#include "gnc/nn/kernels/scalar.hpp"
#include "gnc/nn/kernels/sets.hpp"
#include "gnc/nn/kernels/winograd.hpp"

namespace tumblesight::gnc::kernels {
namespace {

// Bytes 1 and 3 as 16-bit numbers. In assembly, since the compiler does not use the rotation that is part of
// the instruction.
TUMBLESIGHT_INLINE int16x2_t odd_signed(std::uint32_t bytes) {
  int16x2_t numbers;
  asm("sxtb16 %0, %1, ror #8" : "=r"(numbers) : "r"(bytes));
  return numbers;
}

// Convolutions, for WinogradImage.
struct PairsOfProducts {
  // The two numbers of a register do not borrow from each other.
  struct Pairs {
    TUMBLESIGHT_INLINE std::uint32_t add(std::uint32_t a, std::uint32_t b) {
      return static_cast<std::uint32_t>(__sadd16(static_cast<int16x2_t>(a), static_cast<int16x2_t>(b)));
    }
    TUMBLESIGHT_INLINE std::uint32_t sub(std::uint32_t a, std::uint32_t b) {
      return static_cast<std::uint32_t>(__ssub16(static_cast<int16x2_t>(a), static_cast<int16x2_t>(b)));
    }
    template <int kBits>
    TUMBLESIGHT_INLINE std::uint32_t shift(std::uint32_t a) {
      for (int bit = 0; bit < kBits; ++bit) a = add(a, a);
      return a;
    }
    TUMBLESIGHT_INLINE std::uint32_t load(const std::uint8_t* from, int half) {
      return static_cast<std::uint32_t>(__uxtb16(static_cast<uint8x4_t>(load_word(from) >> (8 * half))));
    }
    TUMBLESIGHT_INLINE std::uint32_t load(const std::int8_t* from, int half) {
      return static_cast<std::uint32_t>(__sxtb16(static_cast<int8x4_t>(load_word(from) >> (8 * half))));
    }
    TUMBLESIGHT_INLINE void store(std::uint32_t pair, std::int16_t* to) { store_word(pair, to); }
  };
  static constexpr int kTiles = 3, kChannels = 2, kPair = 2;

  // Adds pairs of input channels, two at a time, until `end`. In assembly, since the compiler loads the words
  // one at a time and runs out of registers. It needs all 13 of them, so it does not compile with a frame
  // pointer.
  TUMBLESIGHT_INLINE void add_pairs(const std::int16_t* in, const std::int16_t* end,
                                    const std::int16_t* weights, std::int32_t (&sum)[kTiles][kChannels]) {
    std::uint64_t weight, value;
    asm("1:\n"
        "ldrd %[weight], %H[weight], [%[weights]], #8\n"
        "ldrd %[value], %H[value], [%[in]], #8\n"
        "smlad %[sum00], %[value], %[weight], %[sum00]\n"
        "smlad %[sum01], %[value], %H[weight], %[sum01]\n"
        "smlad %[sum10], %H[value], %[weight], %[sum10]\n"
        "smlad %[sum11], %H[value], %H[weight], %[sum11]\n"
        "ldrd %[value], %H[value], [%[in]], #8\n"
        "smlad %[sum20], %[value], %[weight], %[sum20]\n"
        "smlad %[sum21], %[value], %H[weight], %[sum21]\n"
        "ldrd %[weight], %H[weight], [%[weights]], #8\n"
        "smlad %[sum00], %H[value], %[weight], %[sum00]\n"
        "smlad %[sum01], %H[value], %H[weight], %[sum01]\n"
        "ldrd %[value], %H[value], [%[in]], #8\n"
        "smlad %[sum10], %[value], %[weight], %[sum10]\n"
        "smlad %[sum11], %[value], %H[weight], %[sum11]\n"
        "cmp %[in], %[end]\n"
        "smlad %[sum20], %H[value], %[weight], %[sum20]\n"
        "smlad %[sum21], %H[value], %H[weight], %[sum21]\n"
        "bne 1b\n"
        : [weight] "=&r"(weight), [value] "=&r"(value), [in] "+&r"(in), [weights] "+&r"(weights),
          [sum00] "+&r"(sum[0][0]), [sum01] "+&r"(sum[0][1]), [sum10] "+&r"(sum[1][0]),
          [sum11] "+&r"(sum[1][1]), [sum20] "+&r"(sum[2][0]), [sum21] "+&r"(sum[2][1])
        : [end] "r"(end)
        : "memory", "cc");
  }

  template <bool kFirst>
  TUMBLESIGHT_INLINE void multiply_add(const std::int16_t* in, const std::int16_t* weights, int count,
                                       std::uint32_t* sums) {
    std::int32_t sum[kTiles][kChannels];
#pragma GCC unroll 3
    for (int t = 0; t < kTiles; ++t) {
#pragma GCC unroll 2
      for (int c = 0; c < kChannels; ++c)
        sum[t][c] = kFirst ? 0 : static_cast<std::int32_t>(sums[t * kChannels + c]);
    }
    add_pairs(in, in + count * kTiles * kPair, weights, sum);
#pragma GCC unroll 3
    for (int t = 0; t < kTiles; ++t) {
#pragma GCC unroll 2
      for (int c = 0; c < kChannels; ++c) sums[t * kChannels + c] = static_cast<std::uint32_t>(sum[t][c]);
    }
  }
};

// Dense layers, for Blocks: two channels. The weights of input 0 are in one word, those of input 1 in the
// other.
struct Int16 {
  using Kind = Int16Product;
  static constexpr int kWidth = 2;
  struct Sums {
    std::int32_t first, second;
  };
  struct Weights {
    int16x2_t input0, input1;
  };
  using Values = std::int32_t;
  TUMBLESIGHT_INLINE Sums load(const std::int32_t* from) { return {from[0], from[1]}; }
  TUMBLESIGHT_INLINE void store(const Sums& sum, std::int32_t* to) {
    to[0] = sum.first;
    to[1] = sum.second;
  }
  TUMBLESIGHT_INLINE Weights weights(const std::int8_t* from) {
    const std::uint32_t both = load_word(from);
    return {__sxtb16(static_cast<int8x4_t>(both)), odd_signed(both)};
  }
  TUMBLESIGHT_INLINE Values values(const std::int16_t* from) { return static_cast<Values>(load_word(from)); }
  TUMBLESIGHT_INLINE void add(Sums& sum, Values value, const Weights& weight) {
    sum.first = __smlabb(weight.input0, value, sum.first);
    sum.second = __smlatb(weight.input0, value, sum.second);
    sum.first = __smlabt(weight.input1, value, sum.first);
    sum.second = __smlatt(weight.input1, value, sum.second);
  }
};

// Only for shapes without a pooled convolution.
void convolve(const ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  Blocks<Scalar<Int8Product>>::all_channels<1, 1>(shape, in, start, weights, out);
}
// A dense layer in parts: the few channels whose sums are in registers together use only a part of a cache
// line of weights, which so stays in the cache for the others.
constexpr int kInputsOfAPart = 48;
void multiply(const ProductShape& shape, const std::int16_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  using AllBlocks = Blocks<Int16>;
  if (shape.rows * shape.columns * shape.strips > 1) {
    AllBlocks::product<2, 1, 2>(shape, in, start, weights, out);
    return;
  }
  ProductShape part = shape;
  for (int first = 0; first < shape.strip_length; first += kInputsOfAPart, start = out) {
    part.strip_length = min(kInputsOfAPart, shape.strip_length - first);
    AllBlocks::product<2, 1, 2>(part, in + first, start, weights + first * shape.channels, out);
  }
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

const Kernels<FixedPoint> kFixedDsp{InstructionSet::kDsp,
                                    1,
                                    convolve,
                                    multiply,
                                    max_pool,
                                    average_pool,
                                    winograd_convolution<PairsOfProducts, MaxPooling<FixedPoint>>,
                                    winograd_convolution<PairsOfProducts, AveragePooling<FixedPoint>>};

}  // namespace tumblesight::gnc::kernels
