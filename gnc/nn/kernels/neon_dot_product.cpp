// Arm's 8-bit dot product (ARMv8.2 and later) for the convolutions; everything else is the same as in NEON.
#include <arm_neon.h>

#include <cstring>

#include "gnc/nn/kernels/blocks.hpp"
#include "gnc/nn/kernels/sets.hpp"

namespace tumblesight::gnc::kernels {
namespace {

// Four channels with four inputs each.
struct Int8 {
  using Kind = Int8Product;
  static constexpr int kWidth = 4;
  using Sums = int32x4_t;
  TUMBLESIGHT_INLINE Sums load(const std::int32_t* from) { return vld1q_s32(from); }
  TUMBLESIGHT_INLINE void store(Sums sum, std::int32_t* to) { vst1q_s32(to, sum); }
  TUMBLESIGHT_INLINE uint8x16_t group(const std::uint8_t* from) {
    std::uint32_t four;
    std::memcpy(&four, from, sizeof four);
    return vreinterpretq_u8_u32(vdupq_n_u32(four));
  }

#if defined(__ARM_FEATURE_MATMUL_INT8)
  using Weights = int8x16_t;
  using Values = uint8x16_t;
  TUMBLESIGHT_INLINE Weights weights(const std::int8_t* from) {
    return vld1q_s8(from);
  }
  TUMBLESIGHT_INLINE Values values(const std::uint8_t* from) {
    return group(from);
  }
  TUMBLESIGHT_INLINE void add(Sums& sum, Values value, Weights weight) {
    sum = vusdotq_s32(sum, value, weight);
  }
#else
  // Products of signed numbers only: x w = (x - 128) w + 128 w, where the last term is the same for every
  // pixel.
  struct Weights {
    int8x16_t weight;
    int32x4_t times_128;
  };
  using Values = int8x16_t;
  TUMBLESIGHT_INLINE Weights weights(const std::int8_t* from) {
    const int8x16_t weight = vld1q_s8(from);
    return {weight, vshlq_n_s32(vdotq_s32(vdupq_n_s32(0), weight, vdupq_n_s8(64)), 1)};
  }
  TUMBLESIGHT_INLINE Values values(const std::uint8_t* from) {
    return vreinterpretq_s8_u8(veorq_u8(group(from), vdupq_n_u8(0x80)));
  }
  TUMBLESIGHT_INLINE void add(Sums& sum, Values value, const Weights& weight) {
    sum = vdotq_s32(vaddq_s32(sum, weight.times_128), weight.weight, value);
  }
#endif
};

void convolve(const ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  Blocks<Int8>::product<5, 4, 8>(shape, in, start, weights, out);
}

}  // namespace

const Kernels<FixedPoint> kFixedDotProduct{
    InstructionSet::kDotProduct, 5, convolve, kFixedNeon.multiply, kFixedNeon.max_pool,
    kFixedNeon.average_pool};

}  // namespace tumblesight::gnc::kernels
