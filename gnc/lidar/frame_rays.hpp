// Frame rays: what a sensor measures along its own rays, as a RangeImage. For the driver of a sensor with
// more rays than a RangeImage takes, or with rays that are not uniform in the tangent of their angle. The
// driver cuts out the middle of the view, or bins it, or both.
#pragma once

#include <cstdint>

#include "gnc/lidar/range_image.hpp"

namespace tumblesight::gnc {

inline constexpr int kMaxSensorRays = 256;  // per side

// The rays of a square sensor. The ray of a row and a column points along (slope[column], 1, -slope[row]) in
// the LRF: +x right, +y boresight, +z up.
struct SensorRays {
  int rays = 0;                  // per side, 1..kMaxSensorRays
  const float* slope = nullptr;  // `rays` values, ascending
};

// The square in the middle of the view that becomes a frame.
struct FrameWindow {
  int rays = 0;                // of the frame, per side: 1..RangeImage::kMaxRays
  float tan_half_fov = 0.0F;   // tangent of half the frame's field of view, above 0
  std::uint32_t fov_urad = 0;  // the same field of view [microradian]
};

// Rays per side of the smallest square in the middle of the view that holds every return; it is even or odd
// as `rays` is. 0 without a return. `ranges`: rays * rays, row by row from the top left, 0 = no return.
int rays_with_returns(const std::uint16_t* ranges, int rays);

// Fills rays, field of view and ranges of `frame`; its number and its time stay as they are. `ranges`: as
// above, unsigned Q9.7 metres.
//
// A ray of the frame stands for the sensor's rays within its cell, a square of the frame's pitch around it;
// without one, for the ray with the nearest row and the nearest column. It reports the nearest of their
// returns, at the same distance along the boresight: exact for a plane across the boresight, and in error
// elsewhere by less than the surface's change of depth over a cell and the sensor's pitch. Same bits on every
// processor.
void make_frame(const std::uint16_t* ranges, const SensorRays& sensor, const FrameWindow& window,
                RangeImage& frame);

}  // namespace tumblesight::gnc
