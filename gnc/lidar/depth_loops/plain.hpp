// The loops, written so that a compiler can vectorise them. Included by one source file an instruction set;
// all of it has internal linkage.
#pragma once

#include "gnc/lidar/depth_loops.hpp"

#define TUMBLESIGHT_INLINE [[gnu::always_inline]] static inline

namespace tumblesight::gnc {
namespace {

using Rays = DepthImageScratch::Rays;
using View = DepthImageScratch::View;
constexpr int kMaxRays = RangeImage::kMaxRays;

// All ones where from <= value < to, else 0.
TUMBLESIGHT_INLINE std::uint16_t within(std::uint16_t value, std::uint16_t from, std::uint16_t to) {
  return mask_of<std::uint16_t>(static_cast<std::uint16_t>(value - from) <
                                static_cast<std::uint16_t>(to - from));
}
TUMBLESIGHT_INLINE std::uint16_t usable(std::uint16_t range) {
  return within(range, kMinRange_counts, kMaxRange_counts + 1);
}
TUMBLESIGHT_INLINE std::int16_t high_half(std::int16_t a, std::int16_t b) {
  return static_cast<std::int16_t>((std::int32_t{a} * b) >> 16);
}
TUMBLESIGHT_INLINE std::uint16_t high_half(std::uint16_t a, std::uint16_t b) {
  return static_cast<std::uint16_t>((std::uint32_t{a} * b) >> 16);
}
// (a b + 2^14) >> 15, written as compilers know it.
TUMBLESIGHT_INLINE std::int16_t product15(std::int16_t a, std::int16_t b) {
  return static_cast<std::int16_t>((((std::int32_t{a} * b) >> 14) + 1) >> 1);
}
TUMBLESIGHT_INLINE std::int16_t sum16(std::int16_t a, std::int16_t b) {
  return static_cast<std::int16_t>(a + b);
}

Survey survey_of(const RangeImage& frame) {
  const int rays = frame.rays * frame.rays;
  std::uint16_t returns = 0, nearest = 0xFFFF, farthest = 0;
  for (int ray = 0; ray < rays; ++ray) {
    const std::uint16_t range = frame.ranges[ray];
    const std::uint16_t good = usable(range);
    returns = static_cast<std::uint16_t>(returns - good);
    nearest = min(nearest, static_cast<std::uint16_t>(range | static_cast<std::uint16_t>(~good)));
    farthest = max(farthest, static_cast<std::uint16_t>(range & good));
  }
  Survey survey;
  survey.returns = returns;
  survey.nearest = nearest;
  survey.farthest = farthest;
  return survey;
}

// Depths of one row of rays along the boresight, in the frame's unit; 0 where there is no usable return.
// Range over sqrt(1 + s), s = u^2 + v^2 < 0.2662, as a polynomial within 2e-5.
TUMBLESIGHT_INLINE void row_depths(const std::uint16_t* __restrict ranges, const Rays& rays, int row,
                                   int count, std::int16_t* __restrict depths) {
  const std::int16_t v_square = rays.square16[row];
  const auto scale = static_cast<std::uint16_t>(1 << rays.range_shift);
  for (int column = 0; column < count; ++column) {
    const std::int16_t s = sum16(rays.square16[column], v_square);  // 16 bits behind the point
    const std::int16_t p3 = sum16(-9761, high_half(s, 5777));       // 15 bits behind the point
    const std::int16_t p2 = sum16(12263, high_half(s, p3));
    const std::int16_t p1 = sum16(-16384, high_half(s, p2));
    const auto inverse = static_cast<std::uint16_t>(65535 + product15(s, p1));
    const auto range = static_cast<std::uint16_t>(ranges[column] & usable(ranges[column]));
    const std::uint16_t twice = high_half(static_cast<std::uint16_t>(range * scale), inverse);
    depths[column] = static_cast<std::int16_t>(twice >> 1);
  }
}

void sum_all_depths(const RangeImage& frame, Rays& rays) {
  std::array<std::int16_t, kMaxRays> depths;
  const int count = frame.rays;
  rays.column_sum.fill(0);
  for (int row = 0; row < count; ++row) {
    row_depths(frame.ranges.data() + row * count, rays, row, count, depths.data());
    std::uint32_t sum = 0;
    for (int column = 0; column < count; ++column) {
      const auto depth = static_cast<std::uint32_t>(depths[column]);
      sum += depth;
      rays.column_sum[column] += depth;
    }
    rays.row_sum[row] = sum;
  }
}

// The cell that stands for none, for the rays of each column.
constexpr std::array<std::uint16_t, kMaxRays> make_spare_cells() {
  std::array<std::uint16_t, kMaxRays> table{};
  for (int column = 0; column < kMaxRays; ++column) {
    table[column] = static_cast<std::uint16_t>(DepthImage::kCells + column % DepthImageScratch::kSpareCells);
  }
  return table;
}
constexpr std::array<std::uint16_t, kMaxRays> kSpare = make_spare_cells();

// Where each ray of a row falls, and with what value.
struct Row {
  std::array<std::uint16_t, kMaxRays> cell;
  std::array<std::uint16_t, kMaxRays> value;
};

TUMBLESIGHT_INLINE void project_row(const std::int16_t* __restrict depths, const View& view, int row,
                                    int count, Row& __restrict out) {
  constexpr std::int16_t kSide = DepthImage::kSide;
  const std::int16_t row_x = view.x.of_row[row], row_down = view.down.of_row[row];
  const std::int16_t row_depth = view.depth.of_row[row];
  const std::int16_t cells = view.cells;
  const std::int16_t middle = view.middle, centroid = view.centroid;
  const std::int16_t radius = view.radius, radius_scale = view.radius_scale,
                     value_of_radius = view.value_of_radius;
  for (int column = 0; column < count; ++column) {
    const std::int16_t depth = depths[column];
    const std::int16_t along_x = high_half(depth, sum16(view.x.of_column[column], row_x));
    const std::int16_t along_down = high_half(depth, sum16(view.down.of_column[column], row_down));
    const std::int16_t x = high_half(sum16(along_x, middle), cells);
    const std::int16_t down = high_half(sum16(along_down, middle), cells);
    const auto inside = static_cast<std::uint16_t>(within(static_cast<std::uint16_t>(depth), 1, 32768) &
                                                   within(static_cast<std::uint16_t>(x), 0, kSide) &
                                                   within(static_cast<std::uint16_t>(down), 0, kSide));
    const auto cell = static_cast<std::uint16_t>(down * kSide + x);
    out.cell[column] = static_cast<std::uint16_t>((cell & inside) | (kSpare[column] & ~inside));

    const std::int16_t view_depth =
        sum16(depth, product15(depth, sum16(view.depth.of_column[column], row_depth)));
    const auto before = static_cast<std::int16_t>(centroid - view_depth);
    const std::int16_t bounded = clamp<std::int16_t>(before, static_cast<std::int16_t>(-radius), radius);
    const std::int16_t value = product15(static_cast<std::int16_t>(bounded * radius_scale), value_of_radius);
    out.value[column] = static_cast<std::uint16_t>(kMiddleValue + value);
  }
}

void accumulate_all(const RangeImage& frame, const Rays& rays, const View& view,
                    std::uint32_t* __restrict cells) {
  constexpr std::uint32_t kOneReturn = 1U << kValueBits;
  constexpr int kApart = 8;  // neighbours fall into one cell, and would wait for each other
  std::array<std::int16_t, kMaxRays> depths;
  Row projected;
  const int count = frame.rays;
  for (int i = 0; i < DepthImage::kCells; ++i) cells[i] = 0;
  for (int row = 0; row < count; ++row) {
    row_depths(frame.ranges.data() + row * count, rays, row, count, depths.data());
    project_row(depths.data(), view, row, count, projected);
    for (int first = 0; first < kApart; ++first) {
      for (int column = first; column < count; column += kApart) {
        std::uint32_t& cell = cells[projected.cell[column]];
        const std::uint32_t added = cell + (kOneReturn | projected.value[column]);
        cell = select(cell < kMostReturns * kOneReturn, added, cell);
      }
    }
  }
}

// 2^16 / count, to the nearest.
constexpr std::array<std::uint32_t, kMostReturns + 1> make_reciprocals() {
  std::array<std::uint32_t, kMostReturns + 1> table{};
  for (std::uint32_t count = 1; count <= kMostReturns; ++count) table[count] = ((2U << 16) / count + 1) / 2;
  return table;
}
constexpr std::array<std::uint32_t, kMostReturns + 1> kReciprocals16 = make_reciprocals();

void encode_all(const std::uint32_t* __restrict cells, std::uint16_t* __restrict depth) {
  for (int i = 0; i < DepthImage::kCells; ++i) {
    const std::uint32_t sum = cells[i] & ((1U << kValueBits) - 1);
    const std::uint32_t count = cells[i] >> kValueBits;
    // A mean of 14 bits, with 16 more, to the depth's 16 bits.
    const std::uint32_t mean = (sum * kReciprocals16[count] + (1U << 13)) >> 14;
    const auto bounded = clamp<std::uint32_t>(mean, DepthImage::kSmallest, DepthImage::kLargest);
    depth[i] = static_cast<std::uint16_t>(bounded & mask_of<std::uint32_t>(count > 0));
  }
}

// As this source file is compiled.
constexpr DepthLoops loops_of(InstructionSet set) {
  return {set, survey_of, sum_all_depths, accumulate_all, encode_all};
}

}  // namespace
}  // namespace tumblesight::gnc
