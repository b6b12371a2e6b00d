// Arm NEON, ARMv7 and ARMv8.
#include <arm_neon.h>

#include <cstring>

#include "gnc/nn/kernels/blocks.hpp"
#include "gnc/nn/kernels/sets.hpp"

namespace tumblesight::gnc::kernels {
namespace {

// Convolution, with products of signed numbers only: x w = (x - 128) w + 128 w, where the last term is the
// same for every pixel. No weight is -128, so the sum of two products fits into 16 bits: two groups are
// multiplied before their products are added in pairs.
constexpr int kQuad = 4;  // channels whose groups fill one vector

TUMBLESIGHT_INLINE int8x16_t minus_128(const std::uint8_t* group) {
  std::uint32_t four;
  std::memcpy(&four, group, sizeof four);
  uint32x4_t broadcast = vdupq_n_u32(four);
  asm("" : "+w"(broadcast));  // keeps the load and the broadcast one instruction
  return vreinterpretq_s8_u32(veorq_u32(broadcast, vdupq_n_u32(0x80808080)));
}
TUMBLESIGHT_INLINE int16x8_t multiply_low(int8x16_t a, int8x16_t b) {
  return vmull_s8(vget_low_s8(a), vget_low_s8(b));
}
TUMBLESIGHT_INLINE int16x8_t multiply_high(int8x16_t a, int8x16_t b) {
#if defined(__aarch64__)
  return vmull_high_s8(a, b);
#else
  return vmull_s8(vget_high_s8(a), vget_high_s8(b));
#endif
}
TUMBLESIGHT_INLINE int16x8_t multiply_add_low(int16x8_t sum, int8x16_t a, int8x16_t b) {
  return vmlal_s8(sum, vget_low_s8(a), vget_low_s8(b));
}
TUMBLESIGHT_INLINE int16x8_t multiply_add_high(int16x8_t sum, int8x16_t a, int8x16_t b) {
#if defined(__aarch64__)
  return vmlal_high_s8(sum, a, b);
#else
  return vmlal_s8(sum, vget_high_s8(a), vget_high_s8(b));
#endif
}

// Sums of four channels, each as two partial sums.
struct Quad {
  int32x4_t low, high;
  TUMBLESIGHT_INLINE int32x4_t add_pairs(const Quad& quad) {
#if defined(__aarch64__)
    return vpaddq_s32(quad.low, quad.high);
#else
    return vcombine_s32(vpadd_s32(vget_low_s32(quad.low), vget_high_s32(quad.low)),
                        vpadd_s32(vget_low_s32(quad.high), vget_high_s32(quad.high)));
#endif
  }
};

// start + 128 times the sum of the weights, for kQuads quads of channels.
template <int kQuads>
TUMBLESIGHT_INLINE void start_sums(const ProductShape& shape, const std::int32_t* start,
                                   const std::int8_t* weights, int32x4_t (&sums)[kQuads]) {
  constexpr int kMaxPairs = 128;  // pairs of weights whose sum fits into 16 bits
  int32x4_t total[kQuads] = {};
  for (int remaining = shape.strips * shape.strip_length / Int8Product::kGroup; remaining > 0;
       remaining -= kMaxPairs) {
    int16x8_t pairs[kQuads] = {};
    for (int i = min(remaining, kMaxPairs); i > 0; --i, weights += shape.channels * Int8Product::kGroup) {
      for (int q = 0; q < kQuads; ++q) pairs[q] = vpadalq_s8(pairs[q], vld1q_s8(weights + 16 * q));
    }
    for (int q = 0; q < kQuads; ++q) total[q] = vpadalq_s16(total[q], pairs[q]);
  }
  for (int q = 0; q < kQuads; ++q)
    sums[q] = vaddq_s32(vld1q_s32(start + kQuad * q), vshlq_n_s32(total[q], 7));
}

template <int kPixels, int kQuads>
TUMBLESIGHT_INLINE void convolve_block(const ProductShape& shape, const std::uint8_t* const (&in)[kPixels],
                                       const int32x4_t (&start)[kQuads], const std::int8_t* weights,
                                       std::int32_t* const (&out)[kPixels]) {
  Quad sum[kPixels][kQuads] = {};
  const int group_step = shape.channels * Int8Product::kGroup;
  for (int strip = 0; strip < shape.strips; ++strip) {
    int at = strip * shape.strip_step;
    const int end = at + shape.strip_length;
    for (; at + 8 <= end; at += 8, weights += 2 * group_step) {
      int8x16_t first[kQuads], second[kQuads];
#pragma GCC unroll 4
      for (int q = 0; q < kQuads; ++q) {
        first[q] = vld1q_s8(weights + 16 * q);
        second[q] = vld1q_s8(weights + group_step + 16 * q);
      }
#pragma GCC unroll 4
      for (int p = 0; p < kPixels; ++p) {
        const int8x16_t value = minus_128(in[p] + at), next_value = minus_128(in[p] + at + 4);
#pragma GCC unroll 4
        for (int q = 0; q < kQuads; ++q) {
          sum[p][q].low = vpadalq_s16(sum[p][q].low,
                                      multiply_add_low(multiply_low(first[q], value), second[q], next_value));
          sum[p][q].high = vpadalq_s16(
              sum[p][q].high, multiply_add_high(multiply_high(first[q], value), second[q], next_value));
          // Two quads at a time: with more the compiler runs out of registers.
          if (q % 2 == 1)
            asm volatile(""
                         : "+w"(sum[p][q - 1].low), "+w"(sum[p][q - 1].high), "+w"(sum[p][q].low),
                           "+w"(sum[p][q].high));
        }
      }
    }
    if (at < end) {
#pragma GCC unroll 4
      for (int p = 0; p < kPixels; ++p) {
        const int8x16_t value = minus_128(in[p] + at);
#pragma GCC unroll 4
        for (int q = 0; q < kQuads; ++q) {
          const int8x16_t weight = vld1q_s8(weights + 16 * q);
          sum[p][q].low = vpadalq_s16(sum[p][q].low, multiply_low(weight, value));
          sum[p][q].high = vpadalq_s16(sum[p][q].high, multiply_high(weight, value));
        }
      }
      weights += group_step;
    }
  }
#pragma GCC unroll 4
  for (int p = 0; p < kPixels; ++p) {
#pragma GCC unroll 4
    for (int q = 0; q < kQuads; ++q)
      vst1q_s32(out[p] + kQuad * q, vaddq_s32(start[q], Quad::add_pairs(sum[p][q])));
  }
}

// All pixels, kPixels at a time, for channels in blocks of kQuads quads. The last block is moved back to end
// at the last pixel; the pixels computed a second time get the same values.
template <int kPixels, int kQuads>
TUMBLESIGHT_INLINE void convolve_all(const ProductShape& shape, const std::uint8_t* in,
                                     const std::int32_t* start, const std::int8_t* weights,
                                     std::int32_t* out) {
  const int pixels = shape.rows * shape.columns;
  for (int c = 0; c < shape.channels; c += kQuads * kQuad) {
    const std::int8_t* const channel_weights = weights + c * Int8Product::kGroup;
    int32x4_t first_sums[kQuads];
    start_sums<kQuads>(shape, start + c, channel_weights, first_sums);
    for (int next = 0; next < pixels; next += kPixels) {
      const int first = min(next, pixels - kPixels);
      const std::uint8_t* block_in[kPixels];
      std::int32_t* block_out[kPixels];
      for (int p = 0; p < kPixels; ++p) {
        const int y = (first + p) / shape.columns;
        block_in[p] = in + y * shape.row_step + (first + p - y * shape.columns) * shape.column_step;
        block_out[p] = out + (first + p) * shape.channels + c;
      }
      convolve_block<kPixels, kQuads>(shape, block_in, first_sums, channel_weights, block_out);
    }
  }
}

// Eight channels.
struct Neon {
  static constexpr int kWidth = 8;
  struct Sums {
    int32x4_t low, high;
  };
  TUMBLESIGHT_INLINE Sums load(const std::int32_t* from) { return {vld1q_s32(from), vld1q_s32(from + 4)}; }
  TUMBLESIGHT_INLINE void store(const Sums& sum, std::int32_t* to) {
    vst1q_s32(to, sum.low);
    vst1q_s32(to + 4, sum.high);
  }
  template <int kInput>
  TUMBLESIGHT_INLINE void add_lane(Sums& sum, int16x4_t value, int16x8_t weight) {
    sum.low = vmlal_lane_s16(sum.low, vget_low_s16(weight), value, kInput);
    sum.high = vmlal_lane_s16(sum.high, vget_high_s16(weight), value, kInput);
  }
};

// Dense layers: the weights are widened to 16 bits, and each input of a group is multiplied with them as a
// lane.
struct Int16 : Neon {
  using Kind = Int16Product;
  struct Weights {
    int16x8_t input[2];
  };
  using Values = int16x4_t;
  TUMBLESIGHT_INLINE Weights weights(const std::int8_t* from) {
    const int8x8x2_t deinterleaved = vld2_s8(from);
    return {{vmovl_s8(deinterleaved.val[0]), vmovl_s8(deinterleaved.val[1])}};
  }
  TUMBLESIGHT_INLINE Values values(const std::int16_t* from) {
    std::uint32_t group;
    std::memcpy(&group, from, sizeof group);
    return vreinterpret_s16_u32(vdup_n_u32(group));
  }
  TUMBLESIGHT_INLINE void add(Sums& sum, Values value, const Weights& weight) {
    add_lane<0>(sum, value, weight.input[0]);
    add_lane<1>(sum, value, weight.input[1]);
  }
};

constexpr int kConvolvedPixels = 2;
#if defined(__aarch64__)
constexpr int kQuads = 4, kPixels = 5, kPacks = 2, kSinglePacks = 8;  // 32 registers
#else
constexpr int kQuads = 2, kPixels = 4, kPacks = 1, kSinglePacks = 4;  // 16 registers
#endif

void convolve(const ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  if (shape.rows * shape.columns >= kConvolvedPixels) {
    convolve_all<kConvolvedPixels, kQuads>(shape, in, start, weights, out);
  } else {
    convolve_all<1, kQuads>(shape, in, start, weights, out);
  }
}
void multiply(const ProductShape& shape, const std::int16_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  Blocks<Int16>::product<kPixels, kPacks, kSinglePacks>(shape, in, start, weights, out);
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

const Kernels<FixedPoint> kFixedNeon{
    InstructionSet::k128Bit, kConvolvedPixels, convolve, multiply, max_pool, average_pool};

}  // namespace tumblesight::gnc::kernels
