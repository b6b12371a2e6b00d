// Arm NEON, ARMv7 and ARMv8. Weights are widened to 16 bits; a group's inputs are multiplied lane by lane.
#include <arm_neon.h>

#include <cstring>

#include "gnc/nn/kernels/blocks.hpp"
#include "gnc/nn/kernels/sets.hpp"

namespace tumblesight::gnc::kernels {
namespace {

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

struct Int8 : Neon {
  using Kind = Int8Product;
  struct Weights {
    int16x8_t of_input[4];
  };
  using Values = int16x4_t;
  TUMBLESIGHT_INLINE Weights weights(const std::int8_t* from) {
    const int8x8x4_t apart = vld4_s8(from);
    return {{vmovl_s8(apart.val[0]), vmovl_s8(apart.val[1]), vmovl_s8(apart.val[2]), vmovl_s8(apart.val[3])}};
  }
  TUMBLESIGHT_INLINE Values values(const std::uint8_t* from) {
    std::uint32_t group;
    std::memcpy(&group, from, sizeof group);
    return vget_low_s16(vreinterpretq_s16_u16(vmovl_u8(vreinterpret_u8_u32(vdup_n_u32(group)))));
  }
  TUMBLESIGHT_INLINE void add(Sums& sum, Values value, const Weights& weight) {
    add_lane<0>(sum, value, weight.of_input[0]);
    add_lane<1>(sum, value, weight.of_input[1]);
    add_lane<2>(sum, value, weight.of_input[2]);
    add_lane<3>(sum, value, weight.of_input[3]);
  }
};

struct Int16 : Neon {
  using Kind = Int16Product;
  struct Weights {
    int16x8_t of_input[2];
  };
  using Values = int16x4_t;
  TUMBLESIGHT_INLINE Weights weights(const std::int8_t* from) {
    const int8x8x2_t apart = vld2_s8(from);
    return {{vmovl_s8(apart.val[0]), vmovl_s8(apart.val[1])}};
  }
  TUMBLESIGHT_INLINE Values values(const std::int16_t* from) {
    std::uint32_t group;
    std::memcpy(&group, from, sizeof group);
    return vreinterpret_s16_u32(vdup_n_u32(group));
  }
  TUMBLESIGHT_INLINE void add(Sums& sum, Values value, const Weights& weight) {
    add_lane<0>(sum, value, weight.of_input[0]);
    add_lane<1>(sum, value, weight.of_input[1]);
  }
};

#if defined(__aarch64__)
constexpr int kPixels = 5, kPacks = 2, kSinglePacks = 8;  // 32 registers
#else
constexpr int kPixels = 4, kPacks = 1, kSinglePacks = 4;  // 16 registers
#endif

void convolve(const ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  Blocks<Int8>::product<kPixels, kPacks, kSinglePacks>(shape, in, start, weights, out);
}
void multiply(const ProductShape& shape, const std::int16_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  Blocks<Int16>::product<kPixels, kPacks, kSinglePacks>(shape, in, start, weights, out);
}
void max_pool(const std::int32_t* sums, int columns, int channels, const std::uint8_t* shift, std::uint8_t* out) {
  pool<FixedPoint, LargestOfFour<FixedPoint>>(sums, columns, channels, shift, out);
}
void average_pool(const std::int32_t* sums, int columns, int channels, const std::uint8_t* shift, std::int16_t* out) {
  pool<FixedPoint, MeanOfFour<FixedPoint>>(sums, columns, channels, shift, out);
}

}  // namespace

const Kernels<FixedPoint> kFixedNeon{InstructionSet::k128Bit, convolve, multiply, max_pool, average_pool};

}  // namespace tumblesight::gnc::kernels
