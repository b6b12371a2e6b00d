// RangeImage: one flash-LiDAR frame as the sensor delivers it.
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::gnc {

// An organized square frame of N x N ranges along rays through the field of view. Ray (row, column) points,
// in the LiDAR reference frame (LRF: +x right, +y boresight, +z up), along (u, 1, v) with
//   u = tan(fov / 2) ((2 column + 1) / N - 1),   v = tan(fov / 2) (1 - (2 row + 1) / N).
// Row 0 is the top and column 0 the left of the frame. A range is the distance along the ray.
struct RangeImage {
  static constexpr int kMaxRays = 128;
  static constexpr int kMaxReturns = kMaxRays * kMaxRays;
  static constexpr float kMetresPerCount = 1.0F / 128.0F;  // unsigned Q9.7

  std::int64_t exposure_time_ns = 0;
  std::uint32_t sequence_number = 0;
  std::uint32_t fov_urad = 0;  // full field of view of both axes [microradian]
  std::uint16_t rays = 0;      // N, rays per side
  std::array<std::uint16_t, kMaxReturns>
      ranges{};  // unsigned Q9.7 m, row-major with N per row; 0 = no return
};

}  // namespace tumblesight::gnc
