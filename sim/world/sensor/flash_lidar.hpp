// FlashLidar: the sensor model. One exposure casts a square grid of rays (Embree, both sides of every face
// reflect), puts the occluder in front, and applies effects (effects.hpp) and ray effects (ray_effects.hpp):
//
//   cast, occlude -> effects on returns -> losses and noise -> effects on readings -> counts -> frame rays
//
// Assumptions and limits without effects: a static scene during the exposure; one return per ray at its
// centre, no beam divergence; every surface reflects at every angle; no multipath and no crosstalk; ranges
// above 500 m (gnc::kMaxRange_m) give no return. With rows one after the other the target turns at its rate
// relative to inertial space and the chaser does not.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

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
// `factor` times the one that fits at 20 m, clamped in the same way.
std::uint32_t fixed_fov_urad(double factor, double swath_m);

class FlashLidar {
 public:
  // Throws std::runtime_error if Embree refuses the mesh.
  explicit FlashLidar(const TriangleMesh& mesh);
  // Each sequence shows one of the bodies, at least one: observed_bodies().
  explicit FlashLidar(const std::vector<TriangleMesh>& bodies);
  ~FlashLidar();
  FlashLidar(const FlashLidar&) = delete;
  FlashLidar& operator=(const FlashLidar&) = delete;

  // Whether the effects on solar panels know which triangles those are.
  bool knows_panels() const;
  // Exact ranges of one flash of rays x rays, without occluder, effects, noise and losses. Thread-safe.
  RangeGrid true_ranges(const FrameTruth& truth, int rays, double swath_m) const;
  // The same with RangeGrid::surfaces.
  RangeGrid true_surfaces(const FrameTruth& truth, int rays, double swath_m) const;

  // Fills rays, field of view and ranges of `frame`; sequence number and exposure time are left to the caller
  // (FrameRenderer sets them). Thread-safe. The same arguments give the same frame.
  void expose(const FrameTruth& truth, const SensorSettings& settings, double swath_m,
              std::uint64_t noise_seed, gnc::RangeImage& frame) const;

 private:
  struct Scene;
  struct Hits;
  struct View {
    int rays = 0;  // per side
    std::uint32_t fov_urad = 0;
    double swath_m = 0.0;
    Eigen::Vector2d shift_rays = Eigen::Vector2d::Zero();  // of every ray: right, up
    double scan_time_s = 0.0;
    RaySpacing spacing = RaySpacing::kTangent;
    bool surfaces = false;  // fill RangeGrid::surfaces
  };

  static View view_of(const FrameTruth& truth, int rays, double swath_m);
  const Scene& scene_of(const FrameTruth& truth) const;
  RangeGrid cast(const FrameTruth& truth, const View& view) const;
  RangeGrid cast_footprints(const FrameTruth& truth, const View& view, double width_rays) const;

  std::vector<std::unique_ptr<Scene>> scenes_;  // one per body
};

}  // namespace tumblesight::sim
