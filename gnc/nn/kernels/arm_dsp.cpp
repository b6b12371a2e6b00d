// Arm's DSP instructions for Cortex-M and Cortex-R: SMLAD adds two 16-bit products to a sum.
#include <arm_acle.h>

#include <cstring>

#include "gnc/nn/kernels/chunked_convolution.hpp"
#include "gnc/nn/kernels/scalar.hpp"
#include "gnc/nn/kernels/sets.hpp"

namespace tumblesight::gnc::kernels {
namespace {

TUMBLESIGHT_INLINE std::uint32_t load_word(const void* from) {
  std::uint32_t bytes;
  std::memcpy(&bytes, from, sizeof bytes);
  return bytes;
}
// Bytes 1 and 3 as 16-bit numbers. In assembly, since the compiler does not use the rotation that is part of
// the instruction.
TUMBLESIGHT_INLINE int16x2_t odd_signed(std::uint32_t bytes) {
  int16x2_t numbers;
  asm("sxtb16 %0, %1, ror #8" : "=r"(numbers) : "r"(bytes));
  return numbers;
}
TUMBLESIGHT_INLINE int16x2_t odd_unsigned(std::uint32_t bytes) {
  int16x2_t numbers;
  asm("uxtb16 %0, %1, ror #8" : "=r"(numbers) : "r"(bytes));
  return numbers;
}

// The four 8-bit inputs or weights of a group as 16-bit factors: numbers 0 and 2 in one word, 1 and 3 in the
// other.
struct Factors {
  int16x2_t even, odd;
};
TUMBLESIGHT_INLINE Factors widened(const std::uint8_t* inputs) {
  const std::uint32_t four = load_word(inputs);
  return {static_cast<int16x2_t>(__uxtb16(four)), odd_unsigned(four)};
}
TUMBLESIGHT_INLINE Factors widened(const std::int8_t* weights) {
  const std::uint32_t four = load_word(weights);
  return {__sxtb16(static_cast<int8x4_t>(four)), odd_signed(four)};
}

// Adds one group of one channel for six pixels. In assembly, since the compiler loads the words one at a time
// and runs out of registers.
TUMBLESIGHT_INLINE void add_group(std::int32_t (&sum)[6], const Factors*& values, const std::int8_t*& weight,
                                  int step) {
  std::int32_t even, odd;
  std::uint64_t value;
  asm("ldr %[odd], [%[weight]]\n"
      "add %[weight], %[weight], %[step]\n"
      "sxtb16 %[even], %[odd]\n"
      "sxtb16 %[odd], %[odd], ror #8\n"
      "ldrd %[value], %H[value], [%[values]], #8\n"
      "smlad %[sum0], %[value], %[even], %[sum0]\n"
      "smlad %[sum0], %H[value], %[odd], %[sum0]\n"
      "ldrd %[value], %H[value], [%[values]], #8\n"
      "smlad %[sum1], %[value], %[even], %[sum1]\n"
      "smlad %[sum1], %H[value], %[odd], %[sum1]\n"
      "ldrd %[value], %H[value], [%[values]], #8\n"
      "smlad %[sum2], %[value], %[even], %[sum2]\n"
      "smlad %[sum2], %H[value], %[odd], %[sum2]\n"
      "ldrd %[value], %H[value], [%[values]], #8\n"
      "smlad %[sum3], %[value], %[even], %[sum3]\n"
      "smlad %[sum3], %H[value], %[odd], %[sum3]\n"
      "ldrd %[value], %H[value], [%[values]], #8\n"
      "smlad %[sum4], %[value], %[even], %[sum4]\n"
      "smlad %[sum4], %H[value], %[odd], %[sum4]\n"
      "ldrd %[value], %H[value], [%[values]], #8\n"
      "smlad %[sum5], %[value], %[even], %[sum5]\n"
      "smlad %[sum5], %H[value], %[odd], %[sum5]\n"
      : [even] "=&r"(even), [odd] "=&r"(odd), [value] "=&r"(value), [values] "+r"(values),
        [weight] "+r"(weight), [sum0] "+r"(sum[0]), [sum1] "+r"(sum[1]), [sum2] "+r"(sum[2]),
        [sum3] "+r"(sum[3]), [sum4] "+r"(sum[4]), [sum5] "+r"(sum[5])
      : [step] "r"(step)
      : "memory");
}

// Convolution, for ChunkedConvolution.
struct Int8 {
  static constexpr int kPixels = 6;
  static constexpr int kChunkGroups = 36;
  static constexpr int kUnrolled = 3;
  using Group = std::array<Factors, kPixels>;

  TUMBLESIGHT_INLINE void prepare(const std::uint8_t* const (&in)[kPixels], int offset, Group& group) {
#pragma GCC unroll 6
    for (int p = 0; p < kPixels; ++p) group[p] = widened(in[p] + offset);
  }

  TUMBLESIGHT_INLINE void add(const Group* chunk, int groups, const std::int32_t* start, int start_step,
                              const std::int8_t* weights, std::int32_t* out, int channels) {
    if (start != out) {
      for (int p = 0; p < kPixels; ++p)
        std::memcpy(out + p * channels, start + p * start_step, sizeof(*start) * channels);
    }
    add_to(out, chunk, groups, weights, channels);
  }

  [[gnu::noinline]] static void add_to(std::int32_t* out, const Group* chunk, int groups,
                                       const std::int8_t* weights, int channels) {
    const int step = channels * Int8Product::kGroup;
    const Factors* const end = chunk[0].data() + groups * kPixels;
    const Factors* const end_unrolled = chunk[0].data() + groups / kUnrolled * kUnrolled * kPixels;
    for (int c = 0; c < channels; ++c, ++out, weights += Int8Product::kGroup) {
      asm("" : "+r"(out));  // keeps one pointer instead of one per pixel
      std::int32_t sum[kPixels];
#pragma GCC unroll 6
      for (int p = 0; p < kPixels; ++p) sum[p] = out[p * channels];
      const std::int8_t* weight = weights;
      const Factors* values = chunk[0].data();
      while (values != end_unrolled) {
        add_group(sum, values, weight, step);
        add_group(sum, values, weight, step);
        add_group(sum, values, weight, step);
      }
      while (values != end) add_group(sum, values, weight, step);
#pragma GCC unroll 6
      for (int p = 0; p < kPixels; ++p) out[p * channels] = sum[p];
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

void convolve(const ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  if (shape.rows * shape.columns >= Int8::kPixels) {
    ChunkedConvolution<Int8>::product(shape, in, start, weights, out);
  } else {
    Blocks<Scalar<Int8Product>>::product<1, 1, 1>(shape, in, start, weights, out);
  }
}
void multiply(const ProductShape& shape, const std::int16_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  Blocks<Int16>::product<2, 1, 4>(shape, in, start, weights, out);
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

const Kernels<FixedPoint> kFixedDsp{InstructionSet::kDsp, Int8::kPixels, convolve, multiply, max_pool,
                                    average_pool};

}  // namespace tumblesight::gnc::kernels
