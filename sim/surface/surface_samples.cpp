#include "sim/surface/surface_samples.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_map>

#include "gnc/rcnn/model_format.hpp"
#include "gnc/surface/surface_model.hpp"
#include "sim/surface/outside_views.hpp"
#include "sim/world/math/random.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {
namespace {

using Eigen::Vector3d;
using gnc::SurfaceModel;

constexpr int kCandidates = 40'000;  // points on the mesh, each with two sides
constexpr int kSeenBy = 2;
constexpr int kSampleRays = 512;  // per side: one meets the target every 0.004 radii
// A larger incidence would not tell the two sides of a thin panel: its slope within a ray exceeds the panel.
constexpr double kLeastFacing = 0.5;
constexpr double kDepthTolerance_radii = 0.001;
constexpr double kHalfDiagonal_rays = 0.71;
constexpr double kSameDirection = 0.5;  // cosine of the angle between two normals
constexpr int kBisections = 24;
// Above the spacing of the points, also on a sphere: 0.08 radii.
constexpr double kFar_radii = 0.1;

struct Sample {
  Vector3d position_m, normal;
  int seen_by = 0;
};

std::vector<Sample> candidates(const TriangleMesh& mesh) {
  std::vector<double> area_until;
  double area = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = mesh.corners_trf_m(i);
    area += (b - a).cross(c - a).norm();
    area_until.push_back(area);
  }
  if (!(area > 0.0)) throw std::invalid_argument(mesh.name + " has no surface");
  Random random(1);
  std::vector<Sample> samples;
  for (int i = 0; i < kCandidates; ++i) {
    const auto found = std::upper_bound(area_until.begin(), area_until.end(), area * random.uniform());
    const auto triangle =
        static_cast<std::size_t>(std::min(found, area_until.end() - 1) - area_until.begin());
    const auto [a, b, c] = mesh.corners_trf_m(triangle);
    const double u = std::sqrt(random.uniform()), v = random.uniform();
    const Vector3d position = (1.0 - u) * a + u * (1.0 - v) * b + u * v * c;
    const Vector3d normal = (b - a).cross(c - a).normalized();
    samples.push_back({position, normal});
    samples.push_back({position, -normal});
  }
  return samples;
}

// Whether the sample is what the sensor sees along the ray through it.
bool is_seen(const Sample& sample, const Eigen::Matrix3d& r_lrf_trf, double range_m, double radius_m,
             const RangeGrid& grid) {
  const Vector3d point_m = r_lrf_trf * sample.position_m + Vector3d(0.0, range_m, 0.0);
  const double facing = -(r_lrf_trf * sample.normal).dot(point_m.normalized());
  if (facing < kLeastFacing) return false;
  const double scale = 0.5 * grid.rays / (grid.tan_half_fov * point_m.y());
  const int column = static_cast<int>(std::floor(0.5 * grid.rays + scale * point_m.x()));
  const int row = static_cast<int>(std::floor(0.5 * grid.rays - scale * point_m.z()));
  if (row < 0 || row >= grid.rays || column < 0 || column >= grid.rays) return false;
  const double slope = std::sqrt(1.0 - facing * facing) / facing;
  const double found_m = grid.range_m[static_cast<std::size_t>(row * grid.rays + column)];
  const double tolerance_m = kDepthTolerance_radii * radius_m + kHalfDiagonal_rays * slope / scale;
  return std::abs(found_m - point_m.norm()) < tolerance_m;
}

void count_views(const TriangleMesh& mesh, std::vector<Sample>& samples) {
  const FlashLidar lidar(mesh);
  const double radius_m = mesh.radius_m();
  for (int i = 0; i < kOutsideViews; ++i) {
    const FrameTruth truth = outside_view(mesh, i);
    const Eigen::Matrix3d r_lrf_trf = truth.q_lrf_trf.toRotationMatrix();
    const RangeGrid grid = lidar.true_ranges(truth, kSampleRays, swath_m(mesh));
    for (Sample& sample : samples) {
      if (is_seen(sample, r_lrf_trf, truth.range_m, radius_m, grid)) ++sample.seen_by;
    }
  }
}

// Takes the samples in their order, each at least `spacing_m` from those on surfaces of similar direction.
std::vector<Sample> spread(const std::vector<Sample>& samples, double spacing_m) {
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> boxes;
  const auto key = [](const Eigen::Vector3i& box) {
    constexpr std::uint64_t kMask = (1U << 21) - 1;
    return (static_cast<std::uint64_t>(box.x()) & kMask) << 42 |
           (static_cast<std::uint64_t>(box.y()) & kMask) << 21 |
           (static_cast<std::uint64_t>(box.z()) & kMask);
  };
  std::vector<Sample> taken;
  const auto is_free = [&](const Sample& sample, const Eigen::Vector3i& box) {
    for (int i = 0; i < 27; ++i) {
      const Eigen::Vector3i beside = box + Eigen::Vector3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      const auto found = boxes.find(key(beside));
      if (found == boxes.end()) continue;
      for (const std::size_t other : found->second) {
        if (taken[other].normal.dot(sample.normal) > kSameDirection &&
            (taken[other].position_m - sample.position_m).norm() < spacing_m) {
          return false;
        }
      }
    }
    return true;
  };
  for (const Sample& sample : samples) {
    const Eigen::Vector3i box = (sample.position_m / spacing_m).array().floor().cast<int>().matrix();
    if (!is_free(sample, box)) continue;
    boxes[key(box)].push_back(taken.size());
    taken.push_back(sample);
  }
  return taken;
}

void put_sample(const Sample& sample, double radius_m, std::uint8_t* at) {
  for (int k = 0; k < 3; ++k) {
    const double scaled = std::round(SurfaceModel::kRadius * sample.position_m[k] / radius_m);
    const double limited = std::clamp<double>(scaled, -SurfaceModel::kRadius, SurfaceModel::kRadius);
    gnc::model_format::put_u16(at + 2 * k, static_cast<std::uint16_t>(static_cast<std::int16_t>(limited)));
    at[6 + k] = static_cast<std::uint8_t>(
        static_cast<std::int8_t>(std::lround(SurfaceModel::kUnitNormal * sample.normal[k])));
  }
}

std::vector<Vector3d> positions_radii(const SurfaceModel& surface, const Eigen::Matrix3d& turn) {
  std::vector<Vector3d> positions;
  for (int i = 0; i < static_cast<int>(surface.points()); ++i) {
    const auto& [x, y, z] = surface.point(i).position;
    positions.emplace_back(turn * Vector3d(x, y, z) / SurfaceModel::kRadius);
  }
  return positions;
}

double share_far_from(const std::vector<Vector3d>& others, const std::vector<Vector3d>& points) {
  const auto is_far = [&others](const Vector3d& point) {
    return std::none_of(others.begin(), others.end(), [&point](const Vector3d& other) {
      return (other - point).squaredNorm() <= kFar_radii * kFar_radii;
    });
  };
  const auto far = std::count_if(points.begin(), points.end(), is_far);
  return static_cast<double>(far) / static_cast<double>(points.size());
}

}  // namespace

double unlike_share(const SurfaceModel& surface, const SurfaceModel& other, const Eigen::Matrix3d& turn) {
  if (!surface.is_known() || !other.is_known()) return 0.0;
  const auto one = positions_radii(surface, Eigen::Matrix3d::Identity()), two = positions_radii(other, turn);
  return std::max(share_far_from(one, two), share_far_from(two, one));
}

std::vector<std::uint8_t> surface_section(const TriangleMesh& mesh, double radius_m) {
  std::vector<Sample> samples = candidates(mesh);
  count_views(mesh, samples);
  samples.erase(std::remove_if(samples.begin(), samples.end(),
                               [](const Sample& sample) { return sample.seen_by < kSeenBy; }),
                samples.end());
  double too_close_m = 1e-3 * mesh.radius_m(), spacing_m = 2.0 * mesh.radius_m();
  for (int i = 0; i < kBisections; ++i) {
    const double middle_m = 0.5 * (too_close_m + spacing_m);
    (spread(samples, middle_m).size() > SurfaceModel::kMaxPoints ? too_close_m : spacing_m) = middle_m;
  }
  const std::vector<Sample> taken = spread(samples, spacing_m);
  std::vector<std::uint8_t> section(SurfaceModel::kBytes);
  gnc::model_format::put_u32(section.data(), static_cast<std::uint32_t>(taken.size()));
  gnc::model_format::put_u32(section.data() + 4, static_cast<std::uint32_t>(std::ceil(1000.0 * spacing_m)));
  for (std::size_t i = 0; i < taken.size(); ++i) {
    put_sample(taken[i], radius_m,
               section.data() + SurfaceModel::kHeaderBytes + SurfaceModel::kPointBytes * i);
  }
  return section;
}

}  // namespace tumblesight::sim
