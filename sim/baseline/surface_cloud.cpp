#include "sim/baseline/surface_cloud.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kGoldenAngle_rad = 2.399963229728653;
constexpr double kViewRange_m = 60.0;
constexpr int kViewRays = 128;
constexpr int kMinNeighbours = 6;  // of a plane
constexpr int kSmallestWindow = 1;
constexpr int kLargestWindow = 8;       // rays from the centre to the edge
constexpr double kSlopeSigma = 0.2;     // of a plane that the window is chosen for
constexpr double kOutlier_sigma = 3.0;  // a neighbour farther off belongs to another surface
constexpr double kSmallestOutlier_m = 0.1;

Eigen::Vector3d lattice_direction(int index, int count) {
  const double z = 1.0 - (2.0 * index + 1.0) / count;
  const double r = std::sqrt(1.0 - z * z);
  const double angle = kGoldenAngle_rad * index;
  return {r * std::cos(angle), r * std::sin(angle), z};
}

std::vector<Eigen::Vector3f> normals_of(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals;
  for (const auto& corners : mesh.triangles) {
    const Eigen::Vector3f& a = mesh.vertices_trf_m[corners[0]];
    const Eigen::Vector3f ab = mesh.vertices_trf_m[corners[1]] - a;
    normals.push_back(ab.cross(mesh.vertices_trf_m[corners[2]] - a).normalized());
  }
  return normals;
}

// One standard deviation of the ranges, from the curvature along the rows. Edges and outliers are a minority.
double range_noise_m(const TargetScan& scan) {
  std::vector<double> curvatures_m;
  for (int row = 0; row < scan.rays; ++row) {
    for (int column = 1; column + 1 < scan.rays; ++column) {
      const int ray = row * scan.rays + column;
      const bool three = scan.kind[ray - 1] == RayKind::kReturn && scan.kind[ray] == RayKind::kReturn &&
                         scan.kind[ray + 1] == RayKind::kReturn;
      if (!three) continue;
      curvatures_m.push_back(
          std::abs(scan.range_m[ray - 1] - 2.0 * scan.range_m[ray] + scan.range_m[ray + 1]));
    }
  }
  if (curvatures_m.empty()) return 0.0;
  const auto middle = curvatures_m.begin() + static_cast<std::ptrdiff_t>(curvatures_m.size() / 2);
  std::nth_element(curvatures_m.begin(), middle, curvatures_m.end());
  constexpr double kMedianOfSigma = 0.6745;
  return *middle / (kMedianOfSigma * std::sqrt(6.0));
}

// Rays from the centre to the edge of the smallest window whose plane has the slope to kSlopeSigma.
int window_of(const TargetScan& scan, double noise_m) {
  const double spacing_m = 2.0 * scan.tan_half_fov / scan.rays * scan.centre_range_m;
  for (int half = kSmallestWindow; half < kLargestWindow; ++half) {
    const double side = 2.0 * half + 1.0;
    const double spread_m = spacing_m * std::sqrt(side * side * half * (half + 1.0) / 3.0);
    if (noise_m / spread_m <= kSlopeSigma) return half;
  }
  return kLargestWindow;
}

// Range as a linear function of the steps to the right and downwards from a ray.
struct Plane {
  Eigen::Vector3d coefficients = Eigen::Vector3d::Zero();  // range, per column, per row
  int neighbours = 0;
};

template <typename Accept>
Plane plane_at(const TargetScan& scan, int centre_row, int centre_column, int half, const Accept& accept) {
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  Plane plane;
  const int last = scan.rays - 1;
  for (int row = std::max(0, centre_row - half); row <= std::min(last, centre_row + half); ++row) {
    for (int column = std::max(0, centre_column - half); column <= std::min(last, centre_column + half);
         ++column) {
      const int ray = row * scan.rays + column;
      if (scan.kind[ray] != RayKind::kReturn) continue;
      const Eigen::Vector3d terms(1.0, column - centre_column, row - centre_row);
      if (!accept(terms, scan.range_m[ray])) continue;
      normal_matrix += terms * terms.transpose();
      right_side += terms * scan.range_m[ray];
      ++plane.neighbours;
    }
  }
  // Returns in one line have no slope across it.
  normal_matrix.diagonal().tail<2>().array() += 1e-3;
  if (plane.neighbours > 0) plane.coefficients = normal_matrix.ldlt().solve(right_side);
  return plane;
}

double median_near(const TargetScan& scan, int centre_row, int centre_column, int half) {
  std::vector<double> ranges_m;
  plane_at(scan, centre_row, centre_column, half, [&](const Eigen::Vector3d&, double range_m) {
    ranges_m.push_back(range_m);
    return false;
  });
  const auto middle = ranges_m.begin() + static_cast<std::ptrdiff_t>(ranges_m.size() / 2);
  std::nth_element(ranges_m.begin(), middle, ranges_m.end());
  return *middle;
}

Eigen::Vector3d ray_at(const TargetScan& scan, double row, double column) {
  const auto slope = [&](double index) {
    return scan.tan_half_fov * ((2.0 * index + 1.0) / scan.rays - 1.0);
  };
  return Eigen::Vector3d(slope(column), 1.0, -slope(row)).normalized();
}

double one_way_misfit_m2(const SurfaceCloud& from, const SurfaceCloud& to, double limit_m) {
  double sum_m2 = 0.0;
  for (const Eigen::Vector3f& point_m : from.points_m) {
    float nearest_m2 = static_cast<float>(limit_m * limit_m);
    for (const Eigen::Vector3f& other_m : to.points_m)
      nearest_m2 = std::min(nearest_m2, (other_m - point_m).squaredNorm());
    sum_m2 += nearest_m2;
  }
  return sum_m2 / static_cast<double>(from.size());
}

void add_point(const TargetScan& scan, int row, int column, const Plane& plane, SurfaceCloud& cloud) {
  const auto point = [&](int down, int right) -> Eigen::Vector3d {
    return plane.coefficients.dot(Eigen::Vector3d(1.0, right, down)) *
           ray_at(scan, row + down, column + right);
  };
  const Eigen::Vector3d here = point(0, 0);
  Eigen::Vector3d normal = (point(0, 1) - here).cross(point(1, 0) - here).normalized();
  if (normal.dot(here) > 0.0) normal = -normal;
  cloud.points_m.emplace_back(here.cast<float>());
  cloud.normals.emplace_back(normal.cast<float>());
}

}  // namespace

std::vector<SurfaceView> surface_views(const TriangleMesh& mesh, double swath_m, int views) {
  const FlashLidar lidar(mesh);
  const std::vector<Eigen::Vector3f> normals = normals_of(mesh);
  std::vector<SurfaceView> made;
  for (int i = 0; i < views; ++i) {
    const Eigen::Vector3d boresight_trf = lattice_direction(i, views);
    const auto q_lrf_trf = Eigen::Quaterniond::FromTwoVectors(boresight_trf, Eigen::Vector3d::UnitY());
    const FrameTruth truth{q_lrf_trf, Eigen::Vector3d::Zero(), kViewRange_m};
    const RangeGrid grid = lidar.true_surfaces(truth, kViewRays, swath_m);
    SurfaceView view{-boresight_trf.cast<float>(), {}};
    for (std::size_t ray = 0; ray < grid.range_m.size(); ++ray) {
      if (!std::isfinite(grid.range_m[ray])) continue;
      const int row = static_cast<int>(ray) / grid.rays;
      const int column = static_cast<int>(ray) % grid.rays;
      const Eigen::Vector3d direction =
          Eigen::Vector3d(grid.slope(column), 1.0, -grid.slope(row)).normalized();
      const Eigen::Vector3d point_lrf_m = grid.range_m[ray] * direction;
      const Eigen::Vector3d point_trf_m =
          q_lrf_trf.conjugate() * (point_lrf_m - Eigen::Vector3d(0.0, kViewRange_m, 0.0));
      const Eigen::Vector3f& normal = normals[grid.surfaces[ray].triangle];
      const bool away = normal.dot(view.towards_sensor) < 0.0F;
      view.cloud.points_m.emplace_back(point_trf_m.cast<float>());
      view.cloud.normals.emplace_back(away ? Eigen::Vector3f(-normal) : normal);
    }
    if (view.cloud.size() > 0) made.push_back(std::move(view));
  }
  return made;
}

SurfaceCloud cloud_of(const TargetScan& scan) {
  const double noise_m = range_noise_m(scan);
  const int half = window_of(scan, noise_m);
  const double outlier_m = std::max(kSmallestOutlier_m, kOutlier_sigma * noise_m);
  SurfaceCloud cloud;
  for (int row = 0; row < scan.rays; ++row) {
    for (int column = 0; column < scan.rays; ++column) {
      if (scan.kind[row * scan.rays + column] != RayKind::kReturn) continue;
      const double median_m = median_near(scan, row, column, 1);
      const Plane first =
          plane_at(scan, row, column, half, [&](const Eigen::Vector3d& terms, double range_m) {
            // A surface that is inclined by 60 degrees may leave the median by that much.
            const double inclined_m = 0.1 * terms.tail<2>().norm();
            return std::abs(range_m - median_m) <= outlier_m + inclined_m;
          });
      const Plane plane =
          plane_at(scan, row, column, half, [&](const Eigen::Vector3d& terms, double range_m) {
            return std::abs(range_m - first.coefficients.dot(terms)) <= outlier_m;
          });
      if (plane.neighbours >= kMinNeighbours) add_point(scan, row, column, plane, cloud);
    }
  }
  return cloud;
}

SurfaceCloud thinned(const SurfaceCloud& cloud, double cell_m) {
  struct Sum {
    Eigen::Vector3f point_m = Eigen::Vector3f::Zero();
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    int count = 0;
  };
  std::map<std::array<int, 4>, Sum> sums;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& point_m = cloud.points_m[i];
    const Eigen::Vector3f& normal = cloud.normals[i];
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    const auto cell = [&](int k) { return static_cast<int>(std::floor(point_m[k] / cell_m)); };
    const int side = 2 * static_cast<int>(axis) + (normal[axis] < 0.0F ? 1 : 0);
    Sum& sum = sums[{cell(0), cell(1), cell(2), side}];
    sum.point_m += point_m;
    sum.normal += normal;
    ++sum.count;
  }
  SurfaceCloud thin;
  for (const auto& [cell, sum] : sums) {
    thin.points_m.emplace_back(sum.point_m / static_cast<float>(sum.count));
    thin.normals.emplace_back(sum.normal.normalized());
  }
  return thin;
}

double misfit_m2(const SurfaceCloud& a, const SurfaceCloud& b, double limit_m) {
  return one_way_misfit_m2(a, b, limit_m) + one_way_misfit_m2(b, a, limit_m);
}

}  // namespace tumblesight::sim
