// DepthLoops: what the projection of a frame does ray by ray and cell by cell, in integers of 16 and 32 bits,
// built for several instruction sets. What stands around it, once a frame, is in depth_image.cpp.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/lidar/depth_image.hpp"
#include "gnc/numerics/instruction_set.hpp"

namespace tumblesight::gnc {

inline constexpr int kMinRange_counts = kMinRange_m * 128;
inline constexpr int kMaxRange_counts = kMaxRange_m * 128;

struct Survey {
  int returns = 0;  // usable ones
  std::uint16_t nearest = 0xFFFF;
  std::uint16_t farthest = 0;
};

// A cell's sum: kValueBits of the sum of its values, above them how many.
inline constexpr int kValueBits = 22;
inline constexpr std::uint32_t kMostReturns = 255;  // of a cell that count
inline constexpr int kMiddleValue = 8192;  // a return as far as the centroid; 0 and 16384: a radius beyond

struct DepthLoops {
  InstructionSet set;
  Survey (*survey)(const RangeImage& frame);
  // Depths along the boresight, summed row by row and column by column into `rays`.
  void (*sum_depths)(const RangeImage& frame, DepthImageScratch::Rays& rays);
  // Adds every usable return to its cell.
  void (*accumulate)(const RangeImage& frame, const DepthImageScratch::Rays& rays,
                     const DepthImageScratch::View& view, std::uint32_t* cells);
  void (*encode)(const std::uint32_t* cells, std::uint16_t* depth);
};

// The fastest of this set and those before it that this build and this processor have.
const DepthLoops& depth_loops_within(InstructionSet set);

}  // namespace tumblesight::gnc
