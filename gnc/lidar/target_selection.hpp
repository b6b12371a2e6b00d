// Which returns of a frame come from the target. A sensor also delivers false returns, hot pixels, gas from
// thrusters, debris and whatever lies behind the target. In integers only; specification: docs/numerics.md.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/lidar/range_image.hpp"

namespace tumblesight::gnc {

inline constexpr int kMinReturns = 16;
inline constexpr int kMinRange_m = 10;   // nearer returns come from the chaser (arm, mast, panel) or from a
                                         // target that reaches beyond
inline constexpr int kMaxRange_m = 500;  // longer ranges count as no return (paper, sensor table)
inline constexpr int kCountsPerMetre = 128;
inline constexpr int kMinRange_counts = kMinRange_m * kCountsPerMetre;
inline constexpr int kMaxRange_counts = kMaxRange_m * kCountsPerMetre;

// How far neighbouring ranges on the target differ at most: its radius, but no more than 10 m.
constexpr int largest_step_counts(std::uint32_t target_radius_mm) {
  constexpr std::uint32_t kLargest_mm = 10'000;
  const std::uint32_t step_mm = target_radius_mm < kLargest_mm ? target_radius_mm : kLargest_mm;
  return static_cast<int>((step_mm * 131) >> 10);  // 131 / 1024 = 0.1279
}

// One bit per ray of a frame. The ray in `column` is bit 31 - column % 32 of word column / 32 of its row;
// bits beyond the frame's rays are 0.
struct RayMask {
  static constexpr int kColumnsPerWord = 32;
  static constexpr int kWordsPerRow = RangeImage::kMaxRays / kColumnsPerWord;
  using Row = std::array<std::uint32_t, kWordsPerRow>;
  std::array<Row, RangeImage::kMaxRays> rows;

  bool has(int row, int column) const {
    return (word_of(row, column) << (column % kColumnsPerWord)) >> 31 != 0;
  }
  // The rays in `column`, which is even, and in the next one: bit 1 and bit 0.
  std::uint32_t pair(int row, int column) const {
    return (word_of(row, column) >> (kColumnsPerWord - 2 - column % kColumnsPerWord)) & 3U;
  }

 private:
  std::uint32_t word_of(int row, int column) const {
    return rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column / kColumnsPerWord)];
  }
};
// The number of rays in a RayMask::pair().
constexpr int rays_of_pair(std::uint32_t pair) {
  return static_cast<int>((pair + 1) >> 1);
}

// The number of ones in a word of a mask. Internal linkage, since it is compiled for several instruction
// sets.
[[gnu::always_inline]] static inline int count_ones(std::uint32_t word) {
  word -= (word >> 1) & 0x5555'5555U;
  word = (word & 0x3333'3333U) + ((word >> 2) & 0x3333'3333U);
  word = (word + (word >> 4)) & 0x0F0F'0F0FU;
  word += word >> 8;
  return static_cast<int>((word + (word >> 16)) & 0x3FU);
}

// Working memory of the selection. The caller holds it, so that nothing large is on the stack.
struct TargetSelectionScratch {
  static constexpr int kBins = 512;  // of one metre
  using Counts = std::array<std::uint16_t, kBins + 1>;
  Counts returns_before;                              // in the bins before this one
  Counts pairs_before;                                // of them those like the next ray of the row
  std::array<std::uint16_t, kBins> returns_in_slice;  // that begins with this bin
  // In the bins before kMinRange_m, which the others leave out.
  std::array<std::uint16_t, kMinRange_m> near_returns;

  // For each ray the number of chosen rays among the 5 x 5 around it, itself included: bit k of the number is
  // in support[k].
  static constexpr int kSupportBits = 5;
  std::array<RayMask, kSupportBits> support;

  // Blocks of 4 x 4 rays, with a margin of one block.
  static constexpr int kBlockRays = 4;
  static constexpr int kBlocks = RangeImage::kMaxRays / kBlockRays;  // per side
  static constexpr int kStride = kBlocks + 2;
  static constexpr int kAllBlocks = kStride * kStride;
  std::array<std::uint16_t, kAllBlocks> returns_of_block;
  std::array<std::uint16_t, kAllBlocks> part_of_block;    // number of the connected part
  std::array<std::uint16_t, kAllBlocks> returns_of_part;  // by number
};

// Chooses the returns of the target in three steps.
//  1. Of all ranges from kMinRange_m to kMaxRange_m a slice as deep as the target: the nearest that holds
//     clearly more returns than clutter would, and not scattered ones only. If it begins at kMinRange_m, it
//     goes on nearer as long as the returns do. If the returns fall off slowly beyond its ends, since the
//     ranges are noisier than the paper's, it goes on with them, to three times its depth at most.
//  2. If there are isolated returns away from surfaces, every return needs neighbours: the denser the
//     clutter, the more. A target of few returns loses none as long as there is no clutter.
//  3. Connected parts of the image that are tiny beside the largest are dropped.
// The instruction count is the same for every frame with the same ray count.
//
// frame             16 to 128 rays a side; any ranges
// target_radius_mm  kMinProjection_mm to kMaxTargetRadius_mm
// scratch           need not be initialized
// mask              the chosen rays; may be none
void select_target(const RangeImage& frame, std::uint32_t target_radius_mm, TargetSelectionScratch& scratch,
                   RayMask& mask);

}  // namespace tumblesight::gnc
