#include "sim/world/target/polygon.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "sim/terminal/text.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Corners = std::vector<Vector3d>;

constexpr double kFlat = 1e-12;     // sine of a corner that counts as straight
constexpr double kStraight = 1e-6;  // rad; a quadrangle's corner that is so nearly straight counts as concave
constexpr long kMostTests = 200'000'000;  // of a corner against an ear, a few seconds for one polygon

// Twice the area, along the mean normal (Newell's method).
Vector3d normal_of(const Corners& corners) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i)
    sum += (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
  return sum;
}

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Without the coordinate along which the normal is longest, which changes no position on the other axes; the
// polygon turns counterclockwise.
std::vector<Vector2d> flattened(const Corners& corners, const Vector3d& normal) {
  Eigen::Index along = 0;
  normal.cwiseAbs().maxCoeff(&along);
  Eigen::Index right = (along + 1) % 3, up = (along + 2) % 3;
  if (normal[along] < 0.0) std::swap(right, up);
  std::vector<Vector2d> flat;
  flat.reserve(corners.size());
  for (const Vector3d& corner : corners) flat.emplace_back(corner[right], corner[up]);
  return flat;
}

// Cuts off one ear after the other: a convex corner whose triangle holds no other corner.
class EarClipper {
 public:
  explicit EarClipper(std::vector<Vector2d> corners) : corners_(std::move(corners)), left_(corners_.size()) {
    const auto count = static_cast<std::uint32_t>(corners_.size());
    next_.resize(count);
    before_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      next_[i] = (i + 1) % count;
      before_[i] = (i + count - 1) % count;
    }
  }

  DividedPolygon divide() {
    DividedPolygon polygon;
    std::uint32_t at = 0;
    while (left_ > 3) {
      if (!find(at, &EarClipper::is_clean_ear) && !find(at, &EarClipper::is_ear)) break;
      cut(at, polygon);
      at = next_[next_[at]];  // not beside the last one, which keeps the triangles wide
    }
    if (left_ == 3) {
      if (turn_at(at) >= 0.0) cut(at, polygon);
    }
    polygon.is_whole = left_ <= 2;
    if (!polygon.is_whole) polygon.missing_area = area_left(at);
    return polygon;
  }

 private:
  using Test = bool (EarClipper::*)(std::uint32_t) const;

  bool find(std::uint32_t& at, Test test) const {
    for (std::size_t i = 0; i < left_ && tests_ < kMostTests; ++i, at = next_[at]) {
      if ((this->*test)(at)) return true;
    }
    return false;
  }

  // Twice the area of the triangle at a corner; below 0 where the polygon is concave, 0 where it is straight.
  double turn_at(std::uint32_t i) const {
    const Vector2d in = corners_[i] - corners_[before_[i]], out = corners_[next_[i]] - corners_[i];
    const double turn = cross(in, out);
    return std::abs(turn) <= kFlat * in.norm() * out.norm() ? 0.0 : turn;
  }

  // No other corner lies in the triangle or on its edges, so no corner is left without a triangle.
  bool is_clean_ear(std::uint32_t i) const { return turn_at(i) > 0.0 && !holds_a_corner(i, true); }
  bool is_ear(std::uint32_t i) const { return turn_at(i) > 0.0 && !holds_a_corner(i, false); }

  bool holds_a_corner(std::uint32_t i, bool with_edges) const {
    const Vector2d &a = corners_[before_[i]], &b = corners_[i], &c = corners_[next_[i]];
    const Vector2d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    for (std::uint32_t other = next_[next_[i]]; other != before_[i]; other = next_[other]) {
      const Vector2d& p = corners_[other];
      ++tests_;
      if ((p.array() < low.array()).any() || (p.array() > high.array()).any()) continue;
      if (p == a || p == b || p == c) continue;  // where the polygon touches itself
      const double least = std::min({cross(b - a, p - a), cross(c - b, p - b), cross(a - c, p - c)});
      if (with_edges ? least >= 0.0 : least > 0.0) return true;
    }
    return false;
  }

  void cut(std::uint32_t i, DividedPolygon& polygon) {
    polygon.triangles.push_back({before_[i], i, next_[i]});
    next_[before_[i]] = next_[i];
    before_[next_[i]] = before_[i];
    --left_;
  }

  double area_left(std::uint32_t first) const {
    double twice = 0.0;
    for (std::uint32_t i = next_[first]; next_[i] != first; i = next_[i])
      twice += cross(corners_[i] - corners_[first], corners_[next_[i]] - corners_[first]);
    return 0.5 * std::abs(twice);
  }

  std::vector<Vector2d> corners_;
  std::vector<std::uint32_t> next_, before_;
  std::size_t left_;
  mutable long tests_ = 0;
};

// Those that do not repeat the one before; the last one is before the first one.
std::vector<std::uint32_t> without_repeated(const Corners& corners) {
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (kept.empty() || corners[i] != corners[kept.back()]) kept.push_back(static_cast<std::uint32_t>(i));
  }
  while (kept.size() > 1 && corners[kept.front()] == corners[kept.back()]) kept.pop_back();
  return kept;
}

// A quadrangle from its concave or straight corner, if it has one.
DividedPolygon divided_quadrangle(const Corners& corners) {
  std::uint32_t start = 0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const auto towards = [&](std::uint32_t other) -> Vector3d {
      return (corners[(i + other) % 4] - corners[i]).normalized();
    };
    const Vector3d diagonal = towards(2);
    const double angle = std::acos(towards(3).dot(diagonal)) + std::acos(towards(1).dot(diagonal));
    if (angle > kPi - kStraight) {
      start = i;
      break;
    }
  }
  DividedPolygon polygon;
  polygon.triangles = {{start, (start + 1) % 4, (start + 2) % 4}, {start, (start + 2) % 4, (start + 3) % 4}};
  return polygon;
}

}  // namespace

DividedPolygon divided(const Corners& corners) {
  const std::vector<std::uint32_t> kept = without_repeated(corners);
  Corners distinct;
  for (const std::uint32_t number : kept) distinct.push_back(corners[number]);
  DividedPolygon polygon;
  if (distinct.size() < 4) {
    polygon.triangles = {{0, 1, 2}};  // without area if fewer than three differ
    if (distinct.size() == 3) polygon.triangles = {{kept[0], kept[1], kept[2]}};
    return polygon;
  }
  const Vector3d normal = normal_of(distinct);
  if (distinct.size() == 4) {
    polygon = divided_quadrangle(distinct);
  } else if (normal.norm() > 0.0) {
    polygon = EarClipper(flattened(distinct, normal)).divide();
    // Seen along the axis, an area is smaller than it is.
    polygon.missing_area *= normal.norm() / normal.cwiseAbs().maxCoeff();
  } else {
    polygon.triangles = {{0, 1, 2}};
    polygon.is_whole = false;
  }
  for (PolygonTriangle& triangle : polygon.triangles) {
    for (std::uint32_t& corner : triangle) corner = kept[corner];
  }
  return polygon;
}

double area_of(const Corners& corners) {
  return 0.5 * normal_of(corners).norm();
}

void PolygonCount::add(const Corners& corners, const DividedPolygon& polygon, std::size_t number) {
  area += area_of(corners);
  if (corners.size() > 3) ++all;
  if (polygon.is_whole) return;
  if (not_whole++ == 0) first = number;
  missing_area += polygon.missing_area;
}

std::string PolygonCount::loss(const char* unit) const {
  if (not_whole == 0) return {};
  char share[32];
  std::snprintf(share, sizeof(share), "%.3g", area > 0.0 ? 100.0 * missing_area / area : 0.0);
  return counted(not_whole, "polygon") + " of " + std::to_string(all) +
         " cannot be divided into triangles, the first in " + unit + " " + std::to_string(first) +
         ": edges cross, or the corners lie on a line; about " + share +
         " % of the surface is missing. Triangulate the mesh in the modelling tool and export it again";
}

}  // namespace tumblesight::sim
