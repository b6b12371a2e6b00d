// FrameView: what registration needs of a frame: which rays return, and an inverse depth, which is linear
// across a plane on the screen (screen.hpp), unlike a range.
//
// Inverse depth of a point with depth Y along the boresight: (reference depth / Y - 1) 2^shift. The shift is
// such that the target, one radius to either side of the reference depth, fills 14 bits with sign.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/lidar/range_image.hpp"
#include "gnc/lidar/range_noise.hpp"
#include "gnc/lidar/target_selection.hpp"

namespace tumblesight::gnc {

struct FrameView {
  static constexpr int kMaxBlocks = RangeImage::kMaxRays / 2;  // of 2 x 2 rays, per side

  int rays = 0;  // per side
  std::int64_t tan_half_fov_q30 = 0;
  std::int32_t reference_depth_um = 0;
  std::int32_t target_radius_um = 0;
  std::int32_t radius_over_depth_q30 = 0;
  int shift = 0;                        // of an inverse depth
  std::int32_t noise_q8 = 0;            // standard deviation of a ray's inverse depth, in 1/256
  std::int32_t rays_per_radius_q8 = 0;  // at the reference depth
  RayMask returned;                     // returns of the target
  RayMask hidden;                       // with a return well in front of it: something hides it
  // Mean inverse depth of the returns in a block of 2 x 2 rays; without a meaning where there is none.
  std::array<std::int16_t, kMaxBlocks * kMaxBlocks> block_inverse_depth;

  bool is_returned(int row, int column) const { return returned.has(row, column); }
  bool is_hidden(int row, int column) const { return hidden.has(row, column); }
  std::int16_t inverse_depth_of_block(int block_row, int block_column) const {
    return block_inverse_depth[block_row * kMaxBlocks + block_column];
  }
};

// False if the reference depth is below two radii, where registration does not work, below 1 m or above 520
// m, or if the target is smaller than a 10,000th of it.
[[nodiscard]] bool make_frame_view(const RangeImage& frame, const RayMask& mask,
                                   std::int32_t reference_depth_um, std::uint32_t target_radius_mm,
                                   const RangeNoise& noise, FrameView& view);

}  // namespace tumblesight::gnc
