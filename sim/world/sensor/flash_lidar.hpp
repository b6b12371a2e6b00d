// FlashLidar: the sensor model. One exposure casts a square grid of rays (Embree, both sides of every face
// reflect), puts the occluder in front and applies the ray effects (ray_effects.hpp).
//
// Assumptions and limits: a static scene during the exposure; one return per ray at its centre, no beam
// divergence; every surface reflects at every angle; no multipath and no crosstalk; ranges above 500 m
// (gnc::kMaxRange_m) give no return.
#pragma once

#include <cstdint>
#include <memory>

#include "gnc/lidar/depth_image.hpp"
#include "sim/world/sensor/frame_truth.hpp"
#include "sim/world/sensor/range_grid.hpp"
#include "sim/world/sensor/sensor_settings.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// Side of the square across the boresight that holds the whole target at any attitude. It determines the
// field of view (fov_urad).
double swath_m(const TriangleMesh& mesh);
// The depth projection of a network for this mesh: that swath, and the mesh's radius as the scale of depth.
gnc::DepthProjection projection_of(const TriangleMesh& mesh);
// Field of view 2 atan(swath / (2 range)), clamped to 1..40 degrees (paper, sensor table).
std::uint32_t fov_urad(double swath_m, double range_m);

class FlashLidar {
 public:
  // Throws std::runtime_error if Embree refuses the mesh.
  explicit FlashLidar(const TriangleMesh& mesh);
  ~FlashLidar();
  FlashLidar(const FlashLidar&) = delete;
  FlashLidar& operator=(const FlashLidar&) = delete;

  // Exact ranges of one flash of rays x rays, without occluder, noise and losses. Thread-safe.
  RangeGrid true_ranges(const FrameTruth& truth, int rays, double swath_m) const;

  // Fills rays, field of view and ranges of `frame`; sequence number and exposure time are left to the caller
  // (FrameRenderer sets them). Thread-safe. The same arguments give the same frame.
  void expose(const FrameTruth& truth, const SensorSettings& settings, double swath_m,
              std::uint64_t noise_seed, gnc::RangeImage& frame) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace tumblesight::sim
