// FlashLidar: the sensor model. Casts the rays of one flash (Embree, two-sided) and adds noise and dropouts.
#pragma once

#include <cstdint>
#include <memory>

#include "gnc/lidar/depth_image.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/sensor/occlusion.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

struct SensorSettings {
  int rays = 128;
  double dropout_share = 0.0;  // of the returns, removed at random
  double outlier_share = 0.0;  // of the returns, wrong by 5 sigma to 20 m, nearer or farther
  bool noise = true;           // sigma = 0.1 m + 0.01 range, Gaussian, along the ray (paper, sensor table)
};

SensorSettings sensor_settings(Condition condition);

// Side of the square across the boresight that holds the whole target at any attitude; the FOV follows from
// it.
double swath_m(const TriangleMesh& mesh);
// How a network for this mesh sees it: that swath, and the radius as the scale of depths.
gnc::DepthProjection projection_of(const TriangleMesh& mesh);
// 2 atan(swath / (2 range)), within 1..40 degrees.
std::uint32_t fov_urad(double swath_m, double range_m);

class FlashLidar {
 public:
  explicit FlashLidar(const TriangleMesh& mesh);  // throws std::runtime_error when Embree refuses the mesh
  ~FlashLidar();
  FlashLidar(const FlashLidar&) = delete;
  FlashLidar& operator=(const FlashLidar&) = delete;

  // Of one flash, without occluder, noise and losses. Thread-safe.
  RangeGrid true_ranges(const FrameTruth& truth, int rays, double swath_m) const;

  // Fills rays, fov and ranges; sequence number and exposure time are the caller's. Thread-safe. The same
  // arguments give the same frame.
  void expose(const FrameTruth& truth, const SensorSettings& settings, double swath_m,
              std::uint64_t noise_seed, gnc::RangeImage& frame) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace tumblesight::sim
