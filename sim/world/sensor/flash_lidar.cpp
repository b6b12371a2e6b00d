#include "sim/world/sensor/flash_lidar.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sim/world/sensor/ray_effects.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kSwathMargin = 1.05;  // room for the nearer parts of the target, which appear larger
constexpr int kPacket = 16;            // rays per call of Embree

// Pose of the sensor in the target's frame.
struct SensorPose {
  Eigen::Matrix3f r_trf_lrf;
  Eigen::Vector3f origin_trf_m;
};

SensorPose pose_of(const FrameTruth& truth, double swath_m) {
  const Eigen::Matrix3d r_trf_lrf = truth.q_lrf_trf.conjugate().toRotationMatrix();
  const Eigen::Vector2d offset_m = truth.offset_swaths * swath_m;
  const Eigen::Vector3d target_lrf_m(offset_m.x(), truth.range_m, offset_m.y());
  return {r_trf_lrf.cast<float>(), (r_trf_lrf * -target_lrf_m).cast<float>()};
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
  const double fov_rad = 2.0 * std::atan(swath_m / (2.0 * range_m));
  return static_cast<std::uint32_t>(
      std::clamp<long>(std::lround(fov_rad * 1e6), gnc::kMinFov_urad, gnc::kMaxFov_urad));
}

struct FlashLidar::Scene {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  ~Scene() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  void build(const TriangleMesh& mesh);
  // Ranges along the first `count` unit directions of a packet (TRF); infinity where nothing is hit.
  std::array<float, kPacket> cast(const Eigen::Vector3f& origin,
                                  const std::array<Eigen::Vector3f, kPacket>& directions, int count) const;
};

void FlashLidar::Scene::build(const TriangleMesh& mesh) {
  device = rtcNewDevice("threads=1");
  if (device == nullptr) throw std::runtime_error("Embree could not be started");
  scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices_trf_m.size()));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t),
                              mesh.triangles.size()));
  if (vertices == nullptr || indices == nullptr)
    throw std::runtime_error("Embree refused the mesh of " + mesh.name);
  for (const Eigen::Vector3f& v : mesh.vertices_trf_m) vertices = std::copy(v.data(), v.data() + 3, vertices);
  for (const auto& t : mesh.triangles) indices = std::copy(t.begin(), t.end(), indices);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
    throw std::runtime_error("Embree could not build the scene of " + mesh.name);
  }
}

std::array<float, kPacket> FlashLidar::Scene::cast(const Eigen::Vector3f& origin,
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
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid.data(), scene, &context, &packet);
  std::array<float, kPacket> ranges;
  for (int i = 0; i < kPacket; ++i) {
    const bool hit = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    ranges[i] = hit ? packet.ray.tfar[i] : std::numeric_limits<float>::infinity();
  }
  return ranges;
}

FlashLidar::FlashLidar(const TriangleMesh& mesh) : scene_(std::make_unique<Scene>()) {
  scene_->build(mesh);
}

FlashLidar::~FlashLidar() = default;

RangeGrid FlashLidar::true_ranges(const FrameTruth& truth, int rays, double swath_m) const {
  RangeGrid grid;
  grid.rays = rays;
  grid.tan_half_fov = std::tan(fov_urad(swath_m, truth.range_m) * 0.5e-6);
  grid.range_m.resize(static_cast<std::size_t>(rays) * static_cast<std::size_t>(rays));
  const SensorPose pose = pose_of(truth, swath_m);

  // Packets of neighbours in a row: Embree is fastest with coherent rays.
  std::array<Eigen::Vector3f, kPacket> directions;
  directions.fill(Eigen::Vector3f::UnitY());
  for (int row = 0; row < rays; ++row) {
    const auto up = static_cast<float>(-grid.slope(row));
    for (int first = 0; first < rays; first += kPacket) {
      const int count = std::min(kPacket, rays - first);
      for (int i = 0; i < count; ++i) {
        const auto right = static_cast<float>(grid.slope(first + i));
        directions[i] = pose.r_trf_lrf * Eigen::Vector3f(right, 1.0F, up).normalized();
      }
      const std::array<float, kPacket> ranges = scene_->cast(pose.origin_trf_m, directions, count);
      std::copy_n(ranges.begin(), count, grid.range_m.begin() + row * rays + first);
    }
  }
  return grid;
}

void FlashLidar::expose(const FrameTruth& truth, const SensorSettings& settings, double swath_m,
                        std::uint64_t noise_seed, gnc::RangeImage& frame) const {
  RangeGrid grid = true_ranges(truth, settings.rays, swath_m);
  occlude(truth.occluder, grid);
  frame.rays = static_cast<std::uint16_t>(settings.rays);
  frame.fov_urad = fov_urad(swath_m, truth.range_m);
  measure_ranges(grid, ray_effects(), settings, noise_seed, frame);
}

}  // namespace tumblesight::sim
