#include "sim/inspection/mesh_symmetry.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/surface/mesh_distance.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Points = std::vector<Eigen::Vector3f>;

constexpr std::size_t kPoints = 500;     // turned
constexpr std::size_t kFewPoints = 100;  // to choose among axes
constexpr std::size_t kFurtherAxes = 3;  // beyond the principal ones
constexpr double kAlike = 0.1;        // relative difference of two extents along which no axis is determined
constexpr double kSameAxis = 0.9995;  // cosine
constexpr int kAxesOfAPlane = 12;
constexpr double kOtherTurns_deg[] = {17.0, 37.0, 83.0, 131.0};

Points some_of(const Points& points, std::size_t count) {
  const std::size_t step = std::max<std::size_t>(1, points.size() / count);
  Points some;
  for (std::size_t i = 0; i < points.size(); i += step) some.push_back(points[i]);
  return some;
}

Vector3d mean_of(const Points& points) {
  Vector3d sum = Vector3d::Zero();
  for (const Eigen::Vector3f& point : points) sum += point.cast<double>();
  return sum / static_cast<double>(points.size());
}

Matrix3d covariance_of(const Points& points, const Vector3d& mean) {
  Matrix3d sum = Matrix3d::Zero();
  for (const Eigen::Vector3f& point : points) {
    const Vector3d off = point.cast<double>() - mean;
    sum += off * off.transpose();
  }
  return sum / static_cast<double>(points.size());
}

Vector3d positive(const Vector3d& axis) {
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0.0 ? Vector3d(-axis) : axis;
}

void add_axis(const Vector3d& axis, std::vector<Vector3d>& axes) {
  const Vector3d unit = positive(axis.normalized());
  const auto same = [&](const Vector3d& other) { return std::abs(other.dot(unit)) > kSameAxis; };
  if (std::none_of(axes.begin(), axes.end(), same)) axes.push_back(unit);
}

// In the plane across `normal`, beginning with a frame's axis if one lies in it.
void add_plane(const Vector3d& normal, std::vector<Vector3d>& axes) {
  Eigen::Index flattest = 0;
  normal.cwiseAbs().minCoeff(&flattest);
  const Vector3d first = (Vector3d::Unit(flattest) - normal[flattest] * normal).normalized();
  for (int i = 0; i < kAxesOfAPlane; ++i)
    add_axis(Eigen::AngleAxisd(kPi * i / kAxesOfAPlane, normal) * first, axes);
}

// Symmetries of the cube, about whose axes models are usually built.
void add_all_around(std::vector<Vector3d>& axes) {
  for (int i = 0; i < 27; ++i) {
    const Vector3d axis(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (axis.norm() > 0.5) add_axis(axis, axes);
  }
}

bool are_alike(double extent_m, double other_m) {
  return std::abs(extent_m - other_m) <= kAlike * std::max(extent_m, other_m);
}

class Turner {
 public:
  Turner(const MeshDistance& distance, Points points, Vector3d centre)
      : distance_(distance), points_(std::move(points)), centre_(std::move(centre)) {}

  // Mean distance of the surface from where it was, of a turn either way.
  double moved_m(const Vector3d& axis, double angle_rad) const {
    double sum_m = 0.0;
    for (const double angle : {angle_rad, -angle_rad}) {
      const Matrix3d turn = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
      for (const Eigen::Vector3f& point : points_) {
        const Vector3d turned = centre_ + turn * (point.cast<double>() - centre_);
        sum_m += distance_.distance_m(turned.cast<float>());
      }
    }
    return sum_m / (2.0 * static_cast<double>(points_.size()));
  }

 private:
  const MeshDistance& distance_;
  Points points_;
  Vector3d centre_;
};

SymmetryAxis turned_about(const Vector3d& axis, const Turner& turner) {
  SymmetryAxis symmetry;
  symmetry.axis_trf = axis;
  for (std::size_t i = 0; i < kFolds.size(); ++i)
    symmetry.moved_m[i] = turner.moved_m(axis, 2.0 * kPi / kFolds[i]);
  for (const double angle_deg : kOtherTurns_deg)
    symmetry.any_turn_m = std::max(symmetry.any_turn_m, turner.moved_m(axis, angle_deg * kRadPerDeg));
  return symmetry;
}

// Those about which a turn moves the surface least.
std::vector<Vector3d> best_of(std::vector<Vector3d> axes, const Turner& turner) {
  std::vector<std::pair<double, std::size_t>> least;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    double moved_m = turner.moved_m(axes[i], kPi);
    for (const int fold : {3, 4}) moved_m = std::min(moved_m, turner.moved_m(axes[i], 2.0 * kPi / fold));
    least.emplace_back(moved_m, i);
  }
  std::sort(least.begin(), least.end());
  std::vector<Vector3d> best;
  for (const auto& [moved_m, i] : least) {
    if (best.size() < kFurtherAxes) best.push_back(axes[i]);
  }
  return best;
}

// Where extents are alike, their principal axes are not determined.
std::vector<Vector3d> further_axes(const std::vector<Vector3d>& principal, const Vector3d& extent_m) {
  const bool first_two = are_alike(extent_m[0], extent_m[1]);
  const bool last_two = are_alike(extent_m[1], extent_m[2]);
  std::vector<Vector3d> axes = principal;
  if (first_two && last_two) add_all_around(axes);
  if (first_two) add_plane(principal[2], axes);
  if (last_two) add_plane(principal[0], axes);
  axes.erase(axes.begin(), axes.begin() + 3);
  return axes;
}

}  // namespace

SurfaceSymmetry symmetry_of(const TriangleMesh& mesh, const Points& points_trf_m) {
  SurfaceSymmetry found;
  found.centre_trf_m = mean_of(points_trf_m);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(covariance_of(points_trf_m, found.centre_trf_m));
  std::vector<Vector3d> axes;
  for (int i = 0; i < 3; ++i) {  // the solver's order is ascending
    axes.push_back(positive(solver.eigenvectors().col(2 - i)));
    found.extent_m[i] = std::sqrt(std::max(0.0, solver.eigenvalues()[2 - i]));
  }
  const MeshDistance distance(mesh);
  const Turner few(distance, some_of(points_trf_m, kFewPoints), found.centre_trf_m);
  for (const Vector3d& axis : best_of(further_axes(axes, found.extent_m), few)) axes.push_back(axis);
  const Turner turner(distance, some_of(points_trf_m, kPoints), found.centre_trf_m);
  for (const Vector3d& axis : axes) found.axes.push_back(turned_about(axis, turner));
  return found;
}

}  // namespace tumblesight::sim
