// Arm's DSP instructions, for Cortex-M and Cortex-R: two 16-bit products added to a sum at once (SMLAD).
#include <arm_acle.h>

#include <cstring>

#include "gnc/nn/kernels/blocks.hpp"
#include "gnc/nn/kernels/sets.hpp"

namespace tumblesight::gnc::kernels {
namespace {

TUMBLESIGHT_INLINE std::uint32_t word(const void* from) {
  std::uint32_t bytes;
  std::memcpy(&bytes, from, sizeof bytes);
  return bytes;
}
TUMBLESIGHT_INLINE std::uint32_t turned(std::uint32_t bytes) {
  return (bytes >> 8) | (bytes << 24);
}

// One channel: inputs 0 and 2 of a group in one word, 1 and 3 in the other.
struct Int8 {
  using Kind = Int8Product;
  static constexpr int kWidth = 1;
  using Sums = std::int32_t;
  struct Weights {
    int16x2_t even, odd;
  };
  using Values = Weights;
  TUMBLESIGHT_INLINE Sums load(const std::int32_t* from) { return *from; }
  TUMBLESIGHT_INLINE void store(Sums sum, std::int32_t* to) { *to = sum; }
  TUMBLESIGHT_INLINE Weights weights(const std::int8_t* from) {
    const std::uint32_t four = word(from);
    return {__sxtb16(static_cast<int8x4_t>(four)), __sxtb16(static_cast<int8x4_t>(turned(four)))};
  }
  TUMBLESIGHT_INLINE Values values(const std::uint8_t* from) {
    const std::uint32_t four = word(from);
    return {static_cast<int16x2_t>(__uxtb16(four)), static_cast<int16x2_t>(__uxtb16(turned(four)))};
  }
  TUMBLESIGHT_INLINE void add(Sums& sum, const Values& value, const Weights& weight) {
    sum = __smlad(weight.even, value.even, sum);
    sum = __smlad(weight.odd, value.odd, sum);
  }
};

// Two channels: their weights of input 0 in one word, of input 1 in the other.
struct Int16 {
  using Kind = Int16Product;
  static constexpr int kWidth = 2;
  struct Sums {
    std::int32_t first, second;
  };
  struct Weights {
    int16x2_t first, second;
  };
  using Values = int16x2_t;
  TUMBLESIGHT_INLINE Sums load(const std::int32_t* from) { return {from[0], from[1]}; }
  TUMBLESIGHT_INLINE void store(const Sums& sum, std::int32_t* to) {
    to[0] = sum.first;
    to[1] = sum.second;
  }
  TUMBLESIGHT_INLINE Weights weights(const std::int8_t* from) {
    const std::uint32_t both = word(from);
    const auto input0 = static_cast<std::uint32_t>(__sxtb16(static_cast<int8x4_t>(both)));
    const auto input1 = static_cast<std::uint32_t>(__sxtb16(static_cast<int8x4_t>(turned(both))));
    return {static_cast<int16x2_t>((input0 & 0xFFFFU) | (input1 << 16)),
            static_cast<int16x2_t>((input0 >> 16) | (input1 & 0xFFFF0000U))};
  }
  TUMBLESIGHT_INLINE Values values(const std::int16_t* from) { return static_cast<int16x2_t>(word(from)); }
  TUMBLESIGHT_INLINE void add(Sums& sum, Values value, const Weights& weight) {
    sum.first = __smlad(weight.first, value, sum.first);
    sum.second = __smlad(weight.second, value, sum.second);
  }
};

void convolve(const ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  Blocks<Int8>::product<2, 2, 4>(shape, in, start, weights, out);
}
void multiply(const ProductShape& shape, const std::int16_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  Blocks<Int16>::product<2, 1, 2>(shape, in, start, weights, out);
}
void max_pool(const std::int32_t* sums, int columns, int channels, const std::uint8_t* shift, std::uint8_t* out) {
  pool<FixedPoint, LargestOfFour<FixedPoint>>(sums, columns, channels, shift, out);
}
void average_pool(const std::int32_t* sums, int columns, int channels, const std::uint8_t* shift, std::int16_t* out) {
  pool<FixedPoint, MeanOfFour<FixedPoint>>(sums, columns, channels, shift, out);
}

}  // namespace

const Kernels<FixedPoint> kFixedDsp{InstructionSet::kDsp, convolve, multiply, max_pool, average_pool};

}  // namespace tumblesight::gnc::kernels
