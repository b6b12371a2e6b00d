#include "sim/baseline/alignment.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace tumblesight::sim {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kResidualLimit = 3.0;  // sigma
constexpr double kDepthGate_m = 0.5;    // or 2.5 sigma if larger: pairs farther apart have little weight
constexpr double kSilhouetteGate_rays = 4.0;  // the same for silhouettes in the last iteration
constexpr double kFirstSilhouetteGate_rays = 12.0;
constexpr double kGrazing = 0.2;  // cosine of the incidence angle below which a pair is not used
// Neighbours farther apart than this many ray spacings lie on two surfaces.
constexpr double kSurfaceStep = 3.0;
constexpr double kMaxTurn_rad = 0.25;     // per step
constexpr double kTurnDamping_rad = 0.5;  // prior of a step: unobservable directions do not move
constexpr double kMoveDamping_m = 1.0;
constexpr double kStill_rad = 5e-4;
constexpr double kStill_m = 2e-3;

// The surface visible from a pose, in the view frame: the sensor rotated so that its +y points at the TRF's
// origin.
struct Surface {
  RangeGrid grid;
  Eigen::Matrix3d r_view_lrf;
  Eigen::Vector3d origin_m;  // origin of the TRF in the view frame

  bool hit(int row, int column) const {
    return row >= 0 && row < grid.rays && column >= 0 && column < grid.rays &&
           std::isfinite(grid.range_m[row * grid.rays + column]);
  }
  Eigen::Vector3d point(int row, int column) const {
    return Eigen::Vector3d(grid.slope(column), 1.0, -grid.slope(row)).normalized() *
           grid.range_m[row * grid.rays + column];
  }
  // The cell of a line of sight; false outside the grid.
  bool cell(const Eigen::Vector3d& direction, int& row, int& column) const {
    const double scale = 0.5 * grid.rays / (grid.tan_half_fov * direction.y());
    column = static_cast<int>(std::floor(0.5 * grid.rays + scale * direction.x()));
    row = static_cast<int>(std::floor(0.5 * grid.rays - scale * direction.z()));
    return row >= 0 && row < grid.rays && column >= 0 && column < grid.rays;
  }
  // Difference of the two neighbouring points in a row or a column; false across an edge.
  bool tangent(int row, int column, int down, int right, Eigen::Vector3d& difference) const {
    if (!hit(row - down, column - right) || !hit(row + down, column + right)) return false;
    difference = point(row + down, column + right) - point(row - down, column - right);
    const double spacing_m = 2.0 * grid.tan_half_fov / grid.rays * origin_m.y();
    return difference.norm() < 2.0 * kSurfaceStep * spacing_m;
  }
};

Surface surface_at(const FlashLidar& lidar, double swath_m, const TargetPose& pose, int rays) {
  Surface surface;
  const auto turn = Eigen::Quaterniond::FromTwoVectors(pose.origin_lrf_m, Eigen::Vector3d::UnitY());
  FrameTruth truth{turn * pose.q_lrf_trf, Eigen::Vector3d::Zero(), pose.origin_lrf_m.norm()};
  surface.grid = lidar.true_ranges(truth, rays, swath_m);
  surface.r_view_lrf = turn.toRotationMatrix();
  surface.origin_m = Eigen::Vector3d(0.0, truth.range_m, 0.0);
  return surface;
}

// 1 at 0, 1/4 at the gate, then decreasing with the fourth power (Geman and McClure).
double robust_weight(double residual, double gate) {
  const double ratio = residual / gate;
  const double w = 1.0 / (1.0 + ratio * ratio);
  return w * w;
}

// Normal equations of a small motion (turn, move) of the target about its origin, in the view frame.
struct Equations {
  Matrix6 information = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();

  // Adds a pair: the point at `arm_m` from the origin should move by `wanted_m` in the direction `along`.
  void add(const Eigen::Vector3d& arm_m, const Eigen::Vector3d& along, double wanted_m, double weight) {
    Vector6 row;
    row << arm_m.cross(along), along;
    information += weight * row * row.transpose();
    gradient += weight * wanted_m * row;
  }

  Vector6 step() const {
    Matrix6 damped = information;
    damped.diagonal().head<3>().array() += 1.0 / (kTurnDamping_rad * kTurnDamping_rad);
    damped.diagonal().tail<3>().array() += 1.0 / (kMoveDamping_m * kMoveDamping_m);
    Vector6 step = damped.ldlt().solve(gradient);
    const double turn = step.head<3>().norm();
    if (turn > kMaxTurn_rad) step *= kMaxTurn_rad / turn;
    return step;
  }
};

struct Normal {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  bool valid = false;
};

std::vector<Normal> normals_of(const Surface& surface) {
  std::vector<Normal> normals(surface.grid.range_m.size());
  for (int row = 0; row < surface.grid.rays; ++row) {
    for (int column = 0; column < surface.grid.rays; ++column) {
      Eigen::Vector3d right, down;
      if (!surface.hit(row, column) || !surface.tangent(row, column, 0, 1, right) ||
          !surface.tangent(row, column, 1, 0, down)) {
        continue;
      }
      normals[row * surface.grid.rays + column] = {right.cross(down).normalized(), true};
    }
  }
  return normals;
}

void add_depth_pairs(const TargetScan& scan, const Surface& surface, Equations& equations) {
  const std::vector<Normal> normals = normals_of(surface);
  for (int ray = 0; ray < scan.rays * scan.rays; ++ray) {
    if (scan.kind[ray] != RayKind::kReturn) continue;
    const Eigen::Vector3d direction = surface.r_view_lrf * scan.direction(ray);
    int row, column;
    if (!surface.cell(direction, row, column)) continue;
    const int cell = row * surface.grid.rays + column;
    if (!normals[cell].valid) continue;
    const double cosine = normals[cell].direction.dot(direction);
    if (std::abs(cosine) < kGrazing) continue;
    // A plane that moves by m changes the range along the ray by n.m / n.d.
    const double wanted_m = scan.range_m[ray] - surface.grid.range_m[cell];
    const double sigma_m = range_sigma_m(surface.grid.range_m[cell]);
    const double weight =
        robust_weight(wanted_m, std::max(kDepthGate_m, 2.5 * sigma_m)) / (sigma_m * sigma_m);
    equations.add(direction * surface.grid.range_m[cell] - surface.origin_m, normals[cell].direction / cosine,
                  wanted_m, weight);
  }
}

void add_silhouette_pairs(const TargetScan& scan, const SilhouetteField& silhouette, const Surface& surface,
                          double gate_rays, Equations& equations) {
  const double rays_to_slope = 2.0 * scan.tan_half_fov / scan.rays;
  const double half_a_cell_rays = surface.grid.tan_half_fov / surface.grid.rays / rays_to_slope;
  const double middle = 0.5 * (scan.rays - 1);
  const Eigen::Matrix3d r_lrf_view = surface.r_view_lrf.transpose();
  for (int row = 0; row < surface.grid.rays; ++row) {
    for (int column = 0; column < surface.grid.rays; ++column) {
      if (!surface.hit(row, column)) continue;
      if (surface.hit(row - 1, column) && surface.hit(row + 1, column) && surface.hit(row, column - 1) &&
          surface.hit(row, column + 1)) {
        continue;
      }
      const Eigen::Vector3d point_m = surface.point(row, column);
      const Eigen::Vector3d lrf_m = r_lrf_view * point_m;
      const double right = lrf_m.x() / lrf_m.y(), up = lrf_m.z() / lrf_m.y();
      SilhouetteField::Distance distance;
      if (!silhouette.at(middle + right / rays_to_slope, middle - up / rays_to_slope, distance)) continue;
      // The centre of the outermost cell lies half a cell inside the rendered silhouette.
      const double out_rays = distance.out_rays + half_a_cell_rays;
      const Eigen::Vector2d g = distance.outwards;
      // A motion m changes the slopes by (m_x - right m_y, m_z - up m_y) / y.
      const Eigen::Vector3d along(g.x(), -right * g.x() - up * g.y(), g.y());
      const double ray_m = rays_to_slope * lrf_m.y();
      equations.add(point_m - surface.origin_m, surface.r_view_lrf * along, -out_rays * ray_m,
                    robust_weight(out_rays, gate_rays) / (ray_m * ray_m));
    }
  }
}

void move(TargetPose& pose, const Vector6& step, const Eigen::Matrix3d& r_view_lrf) {
  const Eigen::Vector3d turn = r_view_lrf.transpose() * step.head<3>();
  const double angle = turn.norm();
  if (angle > 0.0) {
    pose.q_lrf_trf = (Eigen::AngleAxisd(angle, turn / angle) * pose.q_lrf_trf).normalized();
  }
  pose.origin_lrf_m += r_view_lrf.transpose() * step.tail<3>();
}

}  // namespace

TargetPose Alignment::refine(const TargetScan& scan, const SilhouetteField& silhouette, TargetPose pose,
                             int rays, int iterations) const {
  double gate_rays = kFirstSilhouetteGate_rays;
  for (int i = 0; i < iterations; ++i) {
    const Surface surface = surface_at(lidar_, swath_m_, pose, rays);
    Equations equations;
    add_depth_pairs(scan, surface, equations);
    if (pairs_ == AlignmentPairs::kRangesAndSilhouette) {
      add_silhouette_pairs(scan, silhouette, surface, gate_rays, equations);
    }
    const Vector6 step = equations.step();
    move(pose, step, surface.r_view_lrf);
    if (step.head<3>().norm() < kStill_rad && step.tail<3>().norm() < kStill_m) break;
    gate_rays = std::max(kSilhouetteGate_rays, 0.7 * gate_rays);
  }
  return pose;
}

double Alignment::residual_m(const TargetScan& scan, const TargetPose& pose, int rays) const {
  const Surface surface = surface_at(lidar_, swath_m_, pose, rays);
  const double limit_m = kResidualLimit * range_sigma_m(scan.centre_range_m);
  double sum_m2 = 0.0;
  int pairs = 0;
  for (int ray = 0; ray < scan.rays * scan.rays; ++ray) {
    if (scan.kind[ray] != RayKind::kReturn && scan.kind[ray] != RayKind::kMiss) continue;
    int row, column;
    const bool rendered =
        surface.cell(surface.r_view_lrf * scan.direction(ray), row, column) && surface.hit(row, column);
    const bool measured = scan.kind[ray] == RayKind::kReturn;
    if (!rendered && !measured) continue;
    const double apart_m = rendered && measured
                               ? scan.range_m[ray] - surface.grid.range_m[row * surface.grid.rays + column]
                               : limit_m;
    sum_m2 += std::min(apart_m * apart_m, limit_m * limit_m);
    ++pairs;
  }
  return pairs == 0 ? std::numeric_limits<double>::infinity() : std::sqrt(sum_m2 / pairs);
}

}  // namespace tumblesight::sim
