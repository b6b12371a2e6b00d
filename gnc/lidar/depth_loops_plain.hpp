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

// All bits set if from <= value < to, else 0.
TUMBLESIGHT_INLINE std::uint16_t within(std::uint16_t value, std::uint16_t from, std::uint16_t to) {
  return mask_if<std::uint16_t>(static_cast<std::uint16_t>(value - from) <
                                static_cast<std::uint16_t>(to - from));
}
// High half of the product: (a b) >> 16.
TUMBLESIGHT_INLINE std::int16_t multiply_high(std::int16_t a, std::int16_t b) {
  return static_cast<std::int16_t>((std::int32_t{a} * b) >> 16);
}
TUMBLESIGHT_INLINE std::uint16_t multiply_high(std::uint16_t a, std::uint16_t b) {
  return static_cast<std::uint16_t>((std::uint32_t{a} * b) >> 16);
}
// (a b + 2^14) >> 15, in the form that compilers recognize as one instruction.
TUMBLESIGHT_INLINE std::int16_t multiply_q15(std::int16_t a, std::int16_t b) {
  return static_cast<std::int16_t>((((std::int32_t{a} * b) >> 14) + 1) >> 1);
}
// a + b, limited to 16 bits, so that a ray far outside the image is not folded into it.
TUMBLESIGHT_INLINE std::int16_t saturating_sum(std::int32_t a, std::int32_t b) {
#if defined(__ARM_FEATURE_SAT) && !defined(__ARM_NEON)
  return static_cast<std::int16_t>(
      __builtin_arm_ssat(a + b, 16));  // one instruction, which the compiler does not find
#else
  const std::int32_t sum = a + b;
  if constexpr (kHasConditionalMoves)
    return static_cast<std::int16_t>(clamp<std::int32_t>(sum, -32768, 32767));
  const std::int32_t above = (sum + 32768) >> 16;  // 0 if the sum fits
  const std::int32_t is_limited = (above | -above) >> 31;
  return static_cast<std::int16_t>(sum ^ ((sum ^ (sum >> 31) ^ 32767) & is_limited));
#endif
}
// a + b modulo 2^16.
TUMBLESIGHT_INLINE std::int16_t add_int16(std::int16_t a, std::int16_t b) {
  return static_cast<std::int16_t>(a + b);
}

ReturnSummary summarize_returns(const RangeImage& frame, const RayMask& mask) {
  std::array<std::uint16_t, kMaxRays> ranges;
  std::uint16_t returns = 0, nearest = 0xFFFF, farthest = 0;
  for (int row = 0; row < frame.rays; ++row) {
    masked_row(frame, mask.rows[row], row, ranges.data());
    for (int column = 0; column < frame.rays; ++column) {
      const std::uint16_t range = ranges[column];
      const auto good = mask_if<std::uint16_t>(range != 0);
      returns = static_cast<std::uint16_t>(returns - good);
      nearest = min(nearest, static_cast<std::uint16_t>(range | static_cast<std::uint16_t>(~good)));
      farthest = max(farthest, range);
    }
  }
  ReturnSummary summary;
  summary.returns = returns;
  summary.nearest = nearest;
  summary.farthest = farthest;
  return summary;
}

// Depths along the boresight of one row of rays, in the frame's unit; 0 without a return. A depth is the
// range over sqrt(1 + s) with s = u^2 + v^2 < 0.2662, as a polynomial with an error of at most 2e-5.
TUMBLESIGHT_INLINE void row_depths(const std::uint16_t* __restrict ranges, const Rays& rays, int row,
                                   std::int16_t* __restrict depths) {
  const std::int16_t down_square = rays.down_square_q16[row];
  const auto scale = static_cast<std::uint16_t>(1 << rays.range_shift);
  for (int column = 0; column < rays.count; ++column) {
    const std::int16_t s = add_int16(rays.right_square_q16[column], down_square);  // Q0.16
    const std::int16_t p3 = add_int16(-9761, multiply_high(s, 5777));              // Q0.15
    const std::int16_t p2 = add_int16(12263, multiply_high(s, p3));
    const std::int16_t p1 = add_int16(-16384, multiply_high(s, p2));
    const auto inverse = static_cast<std::uint16_t>(65535 + multiply_q15(s, p1));
    const std::uint16_t twice = multiply_high(static_cast<std::uint16_t>(ranges[column] * scale), inverse);
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
  const std::int16_t row_depth = view.depth.row[row];
  const std::int16_t cells = view.cells;
  const std::int16_t middle = view.middle, centroid = view.centroid;
  const std::int16_t radius = view.radius, radius_scale = view.radius_scale,
                     inverse_radius = view.inverse_radius;
  for (int column = 0; column < count; ++column) {
    const std::int16_t depth = depths[column];
    const std::int16_t along_x = multiply_high(depth, saturating_sum(view.x.column[column], row_x));
    const std::int16_t along_down = multiply_high(depth, saturating_sum(view.down.column[column], row_down));
    const std::int16_t x = multiply_high(add_int16(along_x, middle), cells);
    const std::int16_t down = multiply_high(add_int16(along_down, middle), cells);
    const auto inside = static_cast<std::uint16_t>(within(static_cast<std::uint16_t>(depth), 1, 32768) &
                                                   within(static_cast<std::uint16_t>(x), 0, kSide) &
                                                   within(static_cast<std::uint16_t>(down), 0, kSide));
    const auto cell = static_cast<std::uint16_t>(down * kSide + x);
    out.cell[column] = static_cast<std::uint16_t>((cell & inside) | (kSpareCell[column] & ~inside));

    const std::int16_t view_depth =
        saturating_sum(depth, multiply_q15(depth, add_int16(view.depth.column[column], row_depth)));
    const auto before = static_cast<std::int16_t>(centroid - view_depth);
    const std::int16_t bounded = clamp<std::int16_t>(before, static_cast<std::int16_t>(-radius), radius);
    const std::int16_t value =
        multiply_q15(static_cast<std::int16_t>(bounded * radius_scale), inverse_radius);
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
