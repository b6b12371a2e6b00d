#include "sim/world/sensor/flash_lidar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sim/world/dynamics/motion.hpp"
#include "sim/world/math/angles.hpp"
#include "sim/world/sensor/embree_scene.hpp"
#include "sim/world/sensor/ray_effects.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kSwathMargin = 1.05;  // room for the nearer parts of the target, which appear larger
constexpr int kPacket = 16;            // rays per call of Embree
constexpr double kFixedFovRange_m = 20.0;
constexpr int kFootprintSide = 3;       // casts across the footprint of a ray
constexpr int kLeastOfFootprint = 5;    // of the kFootprintSide^2 casts, for a return to be detected
constexpr double kPulseLength_m = 1.5;  // surfaces closer together than this give one return

// Pose of the sensor in the target's frame.
struct SensorPose {
  Eigen::Matrix3f r_trf_lrf;
  Eigen::Vector3f origin_trf_m;
};

// `later_s`: after the frame's time, during which the target turns at its rate.
SensorPose pose_of(const FrameTruth& truth, double swath_m, double later_s = 0.0) {
  Eigen::Quaterniond q_lrf_trf = truth.q_lrf_trf;
  if (later_s != 0.0) q_lrf_trf = spin(q_lrf_trf, truth.rate_lrf_rad_s, later_s);
  const Eigen::Matrix3d r_trf_lrf = q_lrf_trf.conjugate().toRotationMatrix();
  const Eigen::Vector2d offset_m = truth.offset_swaths * swath_m;
  const Eigen::Vector3d target_lrf_m(offset_m.x(), truth.range_m, offset_m.y());
  return {r_trf_lrf.cast<float>(), (r_trf_lrf * -target_lrf_m).cast<float>()};
}

// The corners farthest along +x, -x, +y, -y, +z, -z.
std::array<Eigen::Vector3f, 6> extreme_corners(const TriangleMesh& mesh) {
  std::array<Eigen::Vector3f, 6> corners;
  corners.fill(mesh.vertices_trf_m[mesh.triangles.front().front()]);
  // Not of all vertices: those of a part that is missing or turned away belong to no triangle.
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      const Eigen::Vector3f& vertex = mesh.vertices_trf_m[corner];
      for (int axis = 0; axis < 3; ++axis) {
        if (vertex[axis] > corners[2 * axis][axis]) corners[2 * axis] = vertex;
        if (vertex[axis] < corners[2 * axis + 1][axis]) corners[2 * axis + 1] = vertex;
      }
    }
  }
  return corners;
}

// Of the casts of one footprint, infinity where nothing is hit: the mean of those within a pulse length of
// the nearest. Too little light gives no return.
double range_of_footprint(const std::array<double, kFootprintSide * kFootprintSide>& casts_m) {
  const double nearest_m = *std::min_element(casts_m.begin(), casts_m.end());
  const auto hits = std::count_if(casts_m.begin(), casts_m.end(), [](double m) { return std::isfinite(m); });
  if (hits < kLeastOfFootprint) return std::numeric_limits<double>::infinity();
  double sum_m = 0.0;
  int count = 0;
  for (const double range_m : casts_m) {
    if (range_m > nearest_m + kPulseLength_m) continue;
    sum_m += range_m;
    ++count;
  }
  return sum_m / count;
}

std::uint32_t possible_fov_urad(double fov_urad) {
  return static_cast<std::uint32_t>(
      std::clamp<long>(std::lround(fov_urad), gnc::kMinFov_urad, gnc::kMaxFov_urad));
}

}  // namespace

double swath_m(const TriangleMesh& mesh) {
  return 2.0 * kSwathMargin * mesh.radius_m();
}

gnc::DepthProjection projection_of(const TriangleMesh& mesh) {
  const auto millimetres = [](double metres) {
    return static_cast<std::uint32_t>(std::lround(1e3 * metres));
  };
  return {millimetres(swath_m(mesh)), millimetres(static_cast<double>(mesh.radius_m()))};
}

std::uint32_t fov_urad(double swath_m, double range_m) {
  return possible_fov_urad(2.0 * std::atan(swath_m / (2.0 * range_m)) * 1e6);
}

std::uint32_t fixed_fov_urad(double factor, double swath_m) {
  return possible_fov_urad(factor * 2.0e6 * std::atan(swath_m / (2.0 * kFixedFovRange_m)));
}

// What a packet of rays hits: infinite range where nothing.
struct FlashLidar::Hits {
  std::array<float, kPacket> range_m;
  std::array<float, kPacket> cos_incidence;
  std::array<std::uint32_t, kPacket> triangle;
};

struct FlashLidar::Scene {
  EmbreeScene embree;
  std::vector<std::uint8_t> is_panel;  // per triangle; empty: none is
  std::array<Eigen::Vector3f, 6> corners_trf_m;

  explicit Scene(const TriangleMesh& mesh)
      : embree(mesh), is_panel(mesh.is_panel), corners_trf_m(extreme_corners(mesh)) {}
  // Along the first `count` unit directions of a packet (TRF).
  Hits cast(const Eigen::Vector3f& origin, const std::array<Eigen::Vector3f, kPacket>& directions,
            int count) const;
  SurfaceHit surface_at(const Hits& hits, int ray) const {
    const bool panel =
        !is_panel.empty() && std::isfinite(hits.range_m[ray]) && is_panel[hits.triangle[ray]] != 0;
    return {hits.range_m[ray], hits.cos_incidence[ray], panel, hits.triangle[ray]};
  }
};

FlashLidar::Hits FlashLidar::Scene::cast(const Eigen::Vector3f& origin,
                                         const std::array<Eigen::Vector3f, kPacket>& directions,
                                         int count) const {
  alignas(64) RTCRayHit16 packet;
  alignas(64) std::array<int, kPacket> valid;
  for (int i = 0; i < kPacket; ++i) {
    valid[i] = i < count ? -1 : 0;
    packet.ray.org_x[i] = origin.x();
    packet.ray.org_y[i] = origin.y();
    packet.ray.org_z[i] = origin.z();
    packet.ray.dir_x[i] = directions[i].x();
    packet.ray.dir_y[i] = directions[i].y();
    packet.ray.dir_z[i] = directions[i].z();
    packet.ray.tnear[i] = 0.0F;
    packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
    packet.ray.time[i] = 0.0F;
    packet.ray.mask[i] = 0xFFFFFFFF;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.primID[i] = 0;  // Embree leaves these as they are where nothing is hit
    packet.hit.Ng_x[i] = packet.hit.Ng_y[i] = packet.hit.Ng_z[i] = 0.0F;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid.data(), embree.get(), &context, &packet);
  Hits hits;
  for (int i = 0; i < kPacket; ++i) {
    const bool hit = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    const Eigen::Vector3f normal(packet.hit.Ng_x[i], packet.hit.Ng_y[i], packet.hit.Ng_z[i]);
    hits.range_m[i] = hit ? packet.ray.tfar[i] : std::numeric_limits<float>::infinity();
    hits.cos_incidence[i] = hit ? std::min(1.0F, std::abs(normal.normalized().dot(directions[i]))) : 1.0F;
    hits.triangle[i] = packet.hit.primID[i];
  }
  return hits;
}

FlashLidar::FlashLidar(const TriangleMesh& mesh) : FlashLidar(std::vector<TriangleMesh>{mesh}) {}

FlashLidar::FlashLidar(const std::vector<TriangleMesh>& bodies) {
  for (const TriangleMesh& body : bodies) scenes_.push_back(std::make_unique<Scene>(body));
}

FlashLidar::~FlashLidar() = default;

bool FlashLidar::knows_panels() const {
  return std::all_of(scenes_.begin(), scenes_.end(),
                     [](const auto& scene) { return !scene->is_panel.empty(); });
}

const FlashLidar::Scene& FlashLidar::scene_of(const FrameTruth& truth) const {
  return *scenes_[mix(truth.scene_seed) % scenes_.size()];
}

FlashLidar::View FlashLidar::view_of(const FrameTruth& truth, int rays, double swath_m) {
  View view;
  view.rays = rays;
  view.fov_urad = fov_urad(swath_m, truth.range_m);
  view.swath_m = swath_m;
  return view;
}

RangeGrid FlashLidar::true_ranges(const FrameTruth& truth, int rays, double swath_m) const {
  return cast(truth, view_of(truth, rays, swath_m));
}

RangeGrid FlashLidar::true_surfaces(const FrameTruth& truth, int rays, double swath_m) const {
  View view = view_of(truth, rays, swath_m);
  view.surfaces = true;
  return cast(truth, view);
}

RangeGrid FlashLidar::cast(const FrameTruth& truth, const View& view) const {
  const Scene& scene = scene_of(truth);
  const int rays = view.rays;
  RangeGrid grid;
  grid.rays = rays;
  grid.tan_half_fov = std::tan(view.fov_urad * 0.5e-6);
  grid.range_m.resize(static_cast<std::size_t>(rays) * static_cast<std::size_t>(rays));
  grid.spacing = view.spacing;
  if (view.surfaces) grid.surfaces.resize(grid.range_m.size());

  // Packets of neighbours in a row: Embree is fastest with coherent rays.
  std::array<Eigen::Vector3f, kPacket> directions;
  directions.fill(Eigen::Vector3f::UnitY());
  SensorPose pose = pose_of(truth, view.swath_m);
  for (int row = 0; row < rays; ++row) {
    const double later_s = view.scan_time_s * ((row + 0.5) / rays - 0.5);
    if (later_s != 0.0) pose = pose_of(truth, view.swath_m, later_s);
    const auto up = static_cast<float>(-grid.slope(row, -view.shift_rays.y()));
    for (int first = 0; first < rays; first += kPacket) {
      const int count = std::min(kPacket, rays - first);
      for (int i = 0; i < count; ++i) {
        const auto right = static_cast<float>(grid.slope(first + i, view.shift_rays.x()));
        directions[i] = pose.r_trf_lrf * Eigen::Vector3f(right, 1.0F, up).normalized();
      }
      const Hits hits = scene.cast(pose.origin_trf_m, directions, count);
      const std::size_t place = static_cast<std::size_t>(row) * rays + first;
      std::copy_n(hits.range_m.begin(), count, grid.range_m.begin() + place);
      for (int i = 0; i < count && view.surfaces; ++i) grid.surfaces[place + i] = scene.surface_at(hits, i);
    }
  }
  return grid;
}

// The surface of a ray is the one in the middle of its footprint.
RangeGrid FlashLidar::cast_footprints(const FrameTruth& truth, const View& view, double width_rays) const {
  std::vector<RangeGrid> casts;
  View one = view;
  for (int i = 0; i < kFootprintSide * kFootprintSide; ++i) {
    const Eigen::Vector2d step(i % kFootprintSide - 1, i / kFootprintSide - 1);
    one.shift_rays = width_rays / kFootprintSide * step;
    one.surfaces = view.surfaces && step.isZero();
    casts.push_back(cast(truth, one));
  }
  RangeGrid grid = casts[casts.size() / 2];
  std::array<double, kFootprintSide * kFootprintSide> of_ray_m;
  for (std::size_t ray = 0; ray < grid.range_m.size(); ++ray) {
    for (std::size_t i = 0; i < casts.size(); ++i) of_ray_m[i] = casts[i].range_m[ray];
    const double middle_m = grid.range_m[ray];
    grid.range_m[ray] = range_of_footprint(of_ray_m);
    if (std::isfinite(middle_m) && !std::isfinite(grid.range_m[ray])) lose_return(grid, ray, middle_m);
    if (view.surfaces) grid.surfaces[ray].range_m = grid.range_m[ray];
  }
  return grid;
}

namespace {

std::uint32_t fov_urad_of(const SensorSettings& settings, double swath_m, double range_m) {
  if (settings.fixed_fov > 0.0) return fixed_fov_urad(settings.fixed_fov, swath_m);
  if (settings.fov_deg > 0.0) return possible_fov_urad(1e6 * kRadPerDeg * settings.fov_deg);
  return fov_urad(swath_m, range_m);
}

}  // namespace

void FlashLidar::expose(const FrameTruth& truth, const SensorSettings& settings, double swath_m,
                        std::uint64_t noise_seed, gnc::RangeImage& frame) const {
  View view;
  view.rays = settings.rays;
  view.fov_urad = fov_urad_of(settings, swath_m, truth.range_m);
  view.spacing = settings.spacing;
  view.swath_m = swath_m;
  view.scan_time_s = settings.scan_time_s;
  view.surfaces = need_surfaces(settings.effects);
  RangeGrid grid = settings.footprint_rays > 0.0 ? cast_footprints(truth, view, settings.footprint_rays)
                                                 : cast(truth, view);
  occlude(truth.occluder, grid);
  const Flash flash{truth, swath_m, scene_of(truth).corners_trf_m};
  apply_to_returns(settings.effects, flash, noise_seed, grid);
  std::vector<double> ranges_m = measured_ranges_m(grid, ray_effects(), settings, noise_seed);
  apply_to_readings(settings, truth, noise_seed, ranges_m);
  report_ranges(ranges_m, settings, view.fov_urad, frame);
}

}  // namespace tumblesight::sim
