// TargetWindow: the rays that the depth image is made from. If the target covers few rays of the frame, these
// are new rays over a window around the target, with ranges between those of the frame. Otherwise they are
// the frame's own. In integers only; specification: docs/numerics.md.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/lidar/range_image.hpp"
#include "gnc/lidar/target_selection.hpp"
#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {

// A frame is resampled if the window covers fewer rays than this per side: the network is trained with 100
// and more across the image.
inline constexpr int kFewRays = 90;
// Rays per side of a resampled window.
inline constexpr int kWindowRays = 112;

// Positions along one axis of the frame: its ray k is at k. The window's ray i is at first + i step.
struct WindowAxis {
  std::int32_t first_q16;
  std::int32_t step_q16;
};

struct TargetWindow {
  bool is_resampled;
  int rays;  // per side
  WindowAxis columns, rows;
  int largest_step;  // between neighbouring ranges of one surface [counts]
  // For each ray of a resampled window the column of the frame before it, plus 1, and how far it is from
  // there to the next.
  std::array<std::uint8_t, RangeImage::kMaxRays> column_before;
  std::array<std::uint8_t, RangeImage::kMaxRays> past_column_q8;
};

// Where the target is. Slopes are tangents of angles to the boresight, to the right and downward.
struct WindowPlace {
  std::int64_t tan_half_fov_q30;
  std::int64_t right_q30, down_q30;  // of the window's middle
  std::int64_t size_q30;             // side of the window, as a difference of slopes
  std::uint32_t target_radius_mm;
};

void make_window(const RangeImage& frame, const WindowPlace& place, TargetWindow& window);

// The ranges of the target along one row of a resampled window; 0 = no return. A ray has a return if the
// frame's four rays around it have one on the same surface, by at least half of their bilinear weights.
//
// row  0 to kWindowRays - 1
// out  kWindowRays values
void sample_row(const RangeImage& frame, const RayMask& mask, const TargetWindow& window, int row,
                std::uint16_t* out);

// The ranges of one row of the frame where `bits` has a one, else 0. Internal linkage, since it is compiled
// for several instruction sets. `out`: frame.rays values.
[[gnu::always_inline]] static inline void masked_row(const RangeImage& frame, const RayMask::Row& bits,
                                                     int row, std::uint16_t* __restrict out) {
  const std::uint16_t* const ranges = frame.ranges.data() + row * frame.rays;
  for (int first = 0; first < frame.rays; first += RayMask::kColumnsPerWord) {
    const std::uint32_t word = bits[first / RayMask::kColumnsPerWord];
    const int left = frame.rays - first;
    const int columns = left < RayMask::kColumnsPerWord ? left : RayMask::kColumnsPerWord;
    for (int i = 0; i < columns; ++i)
      out[first + i] =
          static_cast<std::uint16_t>(ranges[first + i] & (static_cast<std::int32_t>(word << i) >> 31));
  }
}

}  // namespace tumblesight::gnc
