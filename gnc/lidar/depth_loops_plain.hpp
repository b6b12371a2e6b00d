// The loops, written so that a compiler can vectorize them. One source file per instruction set includes this
// file. All of it has internal linkage, so that no two instruction sets share code.
#pragma once

#include "gnc/lidar/depth_loops.hpp"

#define TUMBLESIGHT_INLINE [[gnu::always_inline]] static inline

namespace tumblesight::gnc {
namespace {

using Rays = DepthImageScratch::Rays;
using View = DepthImageScratch::View;
constexpr int kMaxRays = RangeImage::kMaxRays;

// The numbers of a row have 16 bits, so that a vector register holds many of them. Elsewhere each of them has
// a register of its own, and cutting it to 16 bits after every operation would take an instruction. No
// operation on a Lane leaves 16 bits, so that both give the same bits.
#if defined(__x86_64__) || defined(__aarch64__) || defined(__ARM_NEON)
using Lane = std::int16_t;
using UnsignedLane = std::uint16_t;
#else
using Lane = std::int32_t;
using UnsignedLane = std::uint32_t;
#endif

// All bits set if 0 <= value < end, else 0.
TUMBLESIGHT_INLINE UnsignedLane below(Lane value, std::int16_t end) {
  if constexpr (sizeof(Lane) == 2)
    return mask_if<UnsignedLane>(static_cast<UnsignedLane>(value) < static_cast<UnsignedLane>(end));
  else
    return static_cast<UnsignedLane>(~sign_mask(value) & sign_mask(value - end));
}
TUMBLESIGHT_INLINE UnsignedLane above_zero(Lane value) {
  if constexpr (sizeof(Lane) == 2)
    return mask_if<UnsignedLane>(value > 0);
  else
    return static_cast<UnsignedLane>(sign_mask(-value));
}
TUMBLESIGHT_INLINE Lane clamp_lane(Lane value, Lane low, Lane high) {
  if constexpr (sizeof(Lane) == 2)
    return clamp<Lane>(value, low, high);
  else
    return static_cast<Lane>(min_small(high, max_small(low, value)));
}
// High half of the product: (a b) >> 16.
TUMBLESIGHT_INLINE Lane multiply_high(Lane a, Lane b) {
  return static_cast<Lane>((std::int32_t{a} * b) >> 16);
}
TUMBLESIGHT_INLINE UnsignedLane unsigned_multiply_high(UnsignedLane a, UnsignedLane b) {
  return static_cast<UnsignedLane>((std::uint32_t{a} * b) >> 16);
}
// (a b + 2^14) >> 15, in the form that compilers recognize as one instruction.
TUMBLESIGHT_INLINE Lane multiply_q15(Lane a, Lane b) {
  return static_cast<Lane>((((std::int32_t{a} * b) >> 14) + 1) >> 1);
}
// a + b, limited to 16 bits, so that a ray far outside the image is not folded into it.
TUMBLESIGHT_INLINE Lane saturating_sum(std::int32_t a, std::int32_t b) {
#if defined(__ARM_FEATURE_SAT) && !defined(__ARM_NEON)
  return static_cast<Lane>(
      __builtin_arm_ssat(a + b, 16));  // one instruction, which the compiler does not find
#else
  const std::int32_t sum = a + b;
  if constexpr (kHasConditionalMoves) return static_cast<Lane>(clamp<std::int32_t>(sum, -32768, 32767));
  const std::int32_t above = (sum + 32768) >> 16;  // 0 if the sum fits
  const std::int32_t is_limited = (above | -above) >> 31;
  return static_cast<Lane>(sum ^ ((sum ^ (sum >> 31) ^ 32767) & is_limited));
#endif
}
TUMBLESIGHT_INLINE Lane add(Lane a, Lane b) {
  return static_cast<Lane>(a + b);
}

ReturnSummary summarize_returns(const RangeImage& frame, const RayMask& mask) {
  constexpr int kColumns = RayMask::kColumnsPerWord;
  ReturnSummary summary;
  std::uint16_t any = 0, common = 0xFFFF;
  for (int row = 0; row < frame.rays; ++row) {
    const std::uint16_t* const ranges = frame.ranges.data() + row * frame.rays;
    for (int first = 0; first < frame.rays; first += kColumns) {
      const std::uint32_t word = mask.rows[row][first / kColumns];
      summary.returns += count_ones(word);
      const int columns = min_small(frame.rays - first, kColumns);
      for (int i = 0; i < columns; ++i) {
        const auto chosen = static_cast<std::uint16_t>(static_cast<std::int32_t>(word << i) >> 31);
        any = static_cast<std::uint16_t>(any | (ranges[first + i] & chosen));
        common = static_cast<std::uint16_t>(common & (ranges[first + i] | ~chosen));
      }
    }
  }
  summary.any_bits = any;
  summary.common_bits = common;
  return summary;
}

// Depths along the boresight of one row of rays, in the frame's unit; 0 without a return. A depth is the
// range over sqrt(1 + s) with s = u^2 + v^2 < 0.2662, as a polynomial with an error of at most 2e-5.
TUMBLESIGHT_INLINE void row_depths(const std::uint16_t* __restrict ranges, const Rays& rays, int row,
                                   std::int16_t* __restrict depths) {
  const Lane down_square = rays.down_square_q16[row];
  const auto scale = static_cast<UnsignedLane>(1 << rays.range_shift);
  for (int column = 0; column < rays.count; ++column) {
    const Lane s = add(rays.right_square_q16[column], down_square);  // Q0.16
    const Lane p3 = add(-9761, multiply_high(s, 5777));              // Q0.15
    const Lane p2 = add(12263, multiply_high(s, p3));
    const Lane p1 = add(-16384, multiply_high(s, p2));
    const auto inverse = static_cast<UnsignedLane>(65535 + multiply_q15(s, p1));
    const UnsignedLane twice =
        unsigned_multiply_high(static_cast<UnsignedLane>(ranges[column] * scale), inverse);
    depths[column] = static_cast<std::int16_t>(twice >> 1);
  }
}

void sum_frame_depths(const RangeImage& frame, const RayMask& mask, Rays& rays) {
  std::array<std::uint16_t, kMaxRays> ranges;
  std::array<std::int16_t, kMaxRays> depths;
  rays.column_sum.fill(0);
  for (int row = 0; row < rays.count; ++row) {
    masked_row(frame, mask.rows[row], row, ranges.data());
    row_depths(ranges.data(), rays, row, depths.data());
    std::uint32_t sum = 0;
    for (int column = 0; column < rays.count; ++column) {
      const auto depth = static_cast<std::uint32_t>(depths[column]);
      sum += depth;
      rays.column_sum[column] += depth;
    }
    rays.row_sum[row] = sum;
  }
}

// The spare cell for the rays of each column that fall into no cell.
constexpr std::array<std::uint16_t, kMaxRays> make_spare_cells() {
  std::array<std::uint16_t, kMaxRays> table{};
  for (int column = 0; column < kMaxRays; ++column) {
    table[column] = static_cast<std::uint16_t>(DepthImage::kCells + column % DepthImageScratch::kSpareCells);
  }
  return table;
}
constexpr std::array<std::uint16_t, kMaxRays> kSpareCell = make_spare_cells();

// The cell and the value of each ray of a row.
struct Row {
  std::array<std::uint16_t, kMaxRays> cell;
  std::array<std::uint16_t, kMaxRays> value;
};

TUMBLESIGHT_INLINE void project_row(const std::int16_t* __restrict depths, const View& view, int row,
                                    int count, Row& __restrict out) {
  constexpr std::int16_t kSide = DepthImage::kSide;
  const std::int32_t row_x = view.x.row[row], row_down = view.down.row[row];
  const Lane row_depth = view.depth.row[row];
  const Lane cells = view.cells;
  const Lane middle = view.middle, centroid = view.centroid;
  const Lane radius = view.radius, radius_scale = view.radius_scale, inverse_radius = view.inverse_radius;
  for (int column = 0; column < count; ++column) {
    const Lane depth = depths[column];
    const Lane along_x = multiply_high(depth, saturating_sum(view.x.column[column], row_x));
    const Lane along_down = multiply_high(depth, saturating_sum(view.down.column[column], row_down));
    const Lane x = multiply_high(add(along_x, middle), cells);
    const Lane down = multiply_high(add(along_down, middle), cells);
    const auto inside = static_cast<UnsignedLane>(above_zero(depth) & below(x, kSide) & below(down, kSide));
    const auto cell = static_cast<UnsignedLane>(down * kSide + x);
    out.cell[column] = static_cast<std::uint16_t>((cell & inside) | (kSpareCell[column] & ~inside));

    const Lane view_depth =
        saturating_sum(depth, multiply_q15(depth, add(view.depth.column[column], row_depth)));
    const auto before = static_cast<Lane>(centroid - view_depth);
    const Lane bounded = clamp_lane(before, static_cast<Lane>(-radius), radius);
    const Lane value = multiply_q15(static_cast<Lane>(bounded * radius_scale), inverse_radius);
    out.value[column] = static_cast<std::uint16_t>(kCentroidValue + value);
  }
}

void accumulate_returns(const RangeImage& frame, DepthImageScratch& scratch) {
  constexpr std::uint32_t kOneReturn = 1U << kValueBits;
  // Neighbours often fall into the same cell, where each addition would wait for the previous one.
  constexpr int kInterleave = 8;
  std::array<std::uint16_t, kMaxRays> ranges;
  std::array<std::int16_t, kMaxRays> depths;
  Row projected;
  const int count = scratch.rays.count;
  std::uint32_t* __restrict const cells = scratch.cells.data();
  for (int i = 0; i < DepthImage::kCells; ++i) cells[i] = 0;
  for (int row = 0; row < count; ++row) {
    if (scratch.window.is_resampled)
      sample_row(frame, scratch.mask, scratch.window, row, ranges.data());
    else
      masked_row(frame, scratch.mask.rows[row], row, ranges.data());
    row_depths(ranges.data(), scratch.rays, row, depths.data());
    project_row(depths.data(), scratch.view, row, count, projected);
    for (int first = 0; first < kInterleave; ++first) {
      for (int column = first; column < count; column += kInterleave) {
        std::uint32_t& cell = cells[projected.cell[column]];
        const std::uint32_t added = cell + (kOneReturn | projected.value[column]);
        cell = select(cell < kMaxReturnsPerCell * kOneReturn, added, cell);
      }
    }
  }
}

// 2^16 / count, rounded to the nearest.
constexpr std::array<std::uint32_t, kMaxReturnsPerCell + 1> make_reciprocals() {
  std::array<std::uint32_t, kMaxReturnsPerCell + 1> table{};
  for (std::uint32_t count = 1; count <= kMaxReturnsPerCell; ++count)
    table[count] = ((2U << 16) / count + 1) / 2;
  return table;
}
constexpr std::array<std::uint32_t, kMaxReturnsPerCell + 1> kReciprocals16 = make_reciprocals();

void encode_cells(const std::uint32_t* __restrict cells, std::uint16_t* __restrict depth) {
  for (int i = 0; i < DepthImage::kCells; ++i) {
    const std::uint32_t sum = cells[i] & ((1U << kValueBits) - 1);
    const std::uint32_t count = cells[i] >> kValueBits;
    // From a mean of 14 bits with 16 fraction bits to a depth of 16 bits.
    const auto mean = static_cast<std::int32_t>((sum * kReciprocals16[count] + (1U << 13)) >> 14);
    const std::int32_t bounded = min_small(DepthImage::kLargest, max_small(DepthImage::kSmallest, mean));
    depth[i] = static_cast<std::uint16_t>(bounded & mask_if<std::int32_t>(count > 0));
  }
}

// The table of the loops as the including source file is compiled.
constexpr DepthLoops make_loops(InstructionSet set) {
  return {set, summarize_returns, sum_frame_depths, accumulate_returns, encode_cells};
}

}  // namespace
}  // namespace tumblesight::gnc
