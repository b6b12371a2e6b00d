// DepthLoops: the part of the projection that runs once per ray or per cell, in integers of 16 and 32 bits,
// compiled for several instruction sets that give the same bits. The part that runs once per frame is in
// depth_image.cpp. Formats: docs/numerics.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "gnc/lidar/depth_image.hpp"
#include "gnc/numerics/instruction_set.hpp"

namespace tumblesight::gnc {

// The ranges `first` and `first` + 1 in one word, to compare them at once. `first`: kFirstOfPair plus an even
// number, where the words are aligned.
inline constexpr int kFirstOfPair = offsetof(RangeImage, ranges) % 4 / 2;
inline std::uint32_t pair_at(const RangeImage& frame, int first) {
  std::uint32_t pair = 0;
  std::memcpy(&pair, __builtin_assume_aligned(&frame.ranges[static_cast<std::size_t>(first)], sizeof pair),
              sizeof pair);
  return pair;
}

// Most rays meet nothing, and are passed in groups. The first place from `next` on (as in pair_at()) whose
// group has a return or reaches beyond the frame's `end`.
inline constexpr int kRaysOfGroup = 8;
inline int skip_empty(const RangeImage& frame, int next, int end) {
  const auto any_return = [&frame](int first) {
    return pair_at(frame, first) | pair_at(frame, first + 2) | pair_at(frame, first + 4) |
           pair_at(frame, first + 6);
  };
  while (next + 2 * kRaysOfGroup <= end && (any_return(next) | any_return(next + kRaysOfGroup)) == 0)
    next += 2 * kRaysOfGroup;
  if (next + kRaysOfGroup <= end && any_return(next) == 0) next += kRaysOfGroup;
  return next;
}

// The target's returns of a frame.
struct ReturnSummary {
  int returns = 0;
  std::uint16_t any_bits = 0;          // that are set in one of the ranges [counts]
  std::uint16_t common_bits = 0xFFFF;  // that are set in all of them
};

// A cell accumulates the sum of its values in the low kValueBits and their number in the bits above.
inline constexpr int kValueBits = 22;
inline constexpr std::uint32_t kMaxReturnsPerCell = 255;  // further returns are ignored
inline constexpr int kCentroidValue =
    8192;  // of a return at the centroid's depth; 0 and 16384: one radius away

struct DepthLoops {
  InstructionSet set;
  ReturnSummary (*summarize_returns)(const RangeImage& frame, const RayMask& mask);
  // Sums the depths along the boresight over each row and each column of the frame; writes rays.row_sum and
  // rays.column_sum.
  void (*sum_depths)(const RangeImage& frame, const RayMask& mask, DepthImageScratch::Rays& rays);
  // Clears scratch.cells and adds every return of the window to its cell.
  void (*accumulate)(const RangeImage& frame, DepthImageScratch& scratch);
  // Mean value of each cell, as a depth in unsigned Q0.16; 0 for an empty cell. `depth`: DepthImage::kCells.
  void (*encode)(const std::uint32_t* cells, std::uint16_t* depth);
};

// The fastest loops, among those that this build contains and this processor runs, for `set` or an
// instruction set before it in kInstructionSets.
const DepthLoops& fastest_depth_loops(InstructionSet set);

// The tables, one source file per instruction set. The CMakeLists.txt of this folder decides which of them a
// build contains.
namespace depth_loops {
extern const DepthLoops kPortable, kAvx2, kAvx512;
}  // namespace depth_loops

}  // namespace tumblesight::gnc
