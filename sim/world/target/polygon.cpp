#include "sim/world/target/polygon.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "sim/host/text.hpp"
#include "sim/world/math/angles.hpp"
#include "sim/world/target/mesh_file.hpp"

namespace tumblesight::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Corners = std::vector<Vector3d>;

constexpr double kFlat = 1e-12;     // sine of a corner that counts as straight
constexpr double kStraight = 1e-6;  // rad; a quadrangle's corner that is so nearly straight counts as concave
constexpr double kTouching = 1e-5;  // share of the extent by which an edge must pass through another
constexpr std::size_t kFewCorners = 64;  // are looked at one by one, without a grid

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

// The corners that are left, by where they lie.
class CornerGrid {
 public:
  explicit CornerGrid(const std::vector<Vector2d>& corners) {
    Vector2d high = low_ = corners.front();
    for (const Vector2d& corner : corners) {
      low_ = low_.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    side_ = static_cast<std::size_t>(std::sqrt(static_cast<double>(corners.size()))) + 1;
    const Vector2d extent = (high - low_).cwiseMax(1e-300);
    per_unit_ = extent.cwiseInverse() * static_cast<double>(side_);
    cells_.resize(side_ * side_);
    for (std::uint32_t i = 0; i < corners.size(); ++i) cell_of(corners[i]).push_back(i);
  }
  void remove(std::uint32_t number, const Vector2d& corner) {
    std::vector<std::uint32_t>& cell = cell_of(corner);
    cell.erase(std::find(cell.begin(), cell.end(), number));
  }
  // The first corner of all cells that touch the box for which `test` is true. Counts cells and corners.
  template <class Test>
  std::optional<std::uint32_t> find(const Vector2d& low, const Vector2d& high, long& tests,
                                    const Test& test) const {
    const std::size_t last_row = index(high, 1), first_column = index(low, 0), last_column = index(high, 0);
    for (std::size_t row = index(low, 1); row <= last_row; ++row) {
      for (std::size_t column = first_column; column <= last_column; ++column) {
        const std::vector<std::uint32_t>& cell = cells_[row * side_ + column];
        tests -= 1 + static_cast<long>(cell.size());
        const auto found = std::find_if(cell.begin(), cell.end(), test);
        if (found != cell.end()) return *found;
      }
    }
    return std::nullopt;
  }

 private:
  // Rises with the place, so no corner within a box lies outside of the box's cells.
  std::size_t index(const Vector2d& place, int axis) const {
    const double cell = (place[axis] - low_[axis]) * per_unit_[axis];
    return std::min(side_ - 1, static_cast<std::size_t>(std::max(0.0, std::min(cell, 1e9))));
  }
  std::vector<std::uint32_t>& cell_of(const Vector2d& corner) {
    return cells_[index(corner, 1) * side_ + index(corner, 0)];
  }

  Vector2d low_, per_unit_;
  std::size_t side_ = 0;
  std::vector<std::vector<std::uint32_t>> cells_;
};

// Cuts off one ear after the other: a convex corner whose triangle holds no other corner.
class EarClipper {
 public:
  EarClipper(const std::vector<Vector2d>& corners, long& tests)
      : corners_(corners), ears_(corners.size()), left_(corners.size()), tests_(tests) {
    const auto count = static_cast<std::uint32_t>(corners_.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      ears_[i].next = (i + 1) % count;
      ears_[i].before = (i + count - 1) % count;
    }
    for (std::uint32_t i = 0; i < count; ++i) renew(i);
    if (count > kFewCorners) grid_ = std::make_unique<CornerGrid>(corners_);
  }

  DividedPolygon divide() {
    DividedPolygon polygon;
    std::uint32_t at = 0;
    while (left_ > 3) {
      if (!find(at, true) && !find(at, false)) break;
      cut(at, polygon);
      at = ears_[ears_[at].next].next;  // not beside the last one, which keeps the triangles wide
    }
    if (left_ == 3) {
      if (ears_[at].turn >= 0.0) cut(at, polygon);
    }
    if (left_ <= 2) return polygon;
    using Fault = DividedPolygon::Fault;
    polygon.fault = left_ > 3 && tests_ <= 0 ? Fault::kNoTestsLeft : Fault::kCrossing;
    polygon.wrong_area = area_left(at);
    return polygon;
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  struct Ear {
    std::uint32_t next = 0, before = 0;
    double turn =
        0.0;  // twice the area of its triangle; below 0 where the polygon is concave, 0 where straight
    bool is_cut = false;
    // A corner that its triangle held, with its edges and without them: while it is left, this is no ear.
    std::uint32_t held_with_edges = kNone, held = kNone;
  };

  // `is_clean`: no other corner lies in the triangle or on its edges, so no corner is left without a
  // triangle.
  bool find(std::uint32_t& at, bool is_clean) {
    for (std::size_t i = 0; i < left_ && tests_ > 0; ++i, at = ears_[at].next) {
      --tests_;
      if (is_ear(at, is_clean)) return true;
    }
    return false;
  }

  bool is_ear(std::uint32_t i, bool is_clean) {
    if (!(ears_[i].turn > 0.0)) return false;
    std::uint32_t& held = is_clean ? ears_[i].held_with_edges : ears_[i].held;
    if (held == kNone || ears_[held].is_cut) held = corner_in(i, is_clean).value_or(kNone);
    return held == kNone;
  }

  std::optional<std::uint32_t> corner_in(std::uint32_t i, bool with_edges) const {
    const Vector2d &a = corners_[ears_[i].before], &b = corners_[i], &c = corners_[ears_[i].next];
    const Vector2d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const auto is_held = [&](std::uint32_t other) {
      const Vector2d& p = corners_[other];
      if ((p.array() < low.array()).any() || (p.array() > high.array()).any()) return false;
      if (p == a || p == b || p == c) return false;  // one of the three, or where the polygon touches itself
      const double least = std::min({cross(b - a, p - a), cross(c - b, p - b), cross(a - c, p - c)});
      return with_edges ? least >= 0.0 : least > 0.0;
    };
    if (grid_) return grid_->find(low, high, tests_, is_held);
    for (std::uint32_t other = ears_[ears_[i].next].next; other != ears_[i].before;
         other = ears_[other].next) {
      --tests_;
      if (is_held(other)) return other;
    }
    return std::nullopt;
  }

  void cut(std::uint32_t i, DividedPolygon& polygon) {
    Ear& ear = ears_[i];
    polygon.triangles.push_back({ear.before, i, ear.next});
    ears_[ear.before].next = ear.next;
    ears_[ear.next].before = ear.before;
    ear.is_cut = true;
    if (grid_) grid_->remove(i, corners_[i]);
    --left_;
    renew(ear.before);
    renew(ear.next);
  }

  // After another corner has come beside it.
  void renew(std::uint32_t i) {
    Ear& ear = ears_[i];
    const Vector2d in = corners_[i] - corners_[ear.before], out = corners_[ear.next] - corners_[i];
    const double turn = cross(in, out);
    ear.turn = std::abs(turn) <= kFlat * in.norm() * out.norm() ? 0.0 : turn;
    ear.held_with_edges = ear.held = kNone;
  }

  double area_left(std::uint32_t first) const {
    double twice = 0.0;
    for (std::uint32_t i = ears_[first].next; ears_[i].next != first; i = ears_[i].next)
      twice += cross(corners_[i] - corners_[first], corners_[ears_[i].next] - corners_[first]);
    return 0.5 * std::abs(twice);
  }

  const std::vector<Vector2d>& corners_;
  std::vector<Ear> ears_;  // one a corner
  std::size_t left_;
  std::unique_ptr<CornerGrid> grid_;
  long& tests_;
};

// Whether two edges pass through each other, and do not only touch.
bool edges_cross(const std::vector<Vector2d>& corners, long& tests) {
  struct Edge {
    Vector2d from, to;
    double low, high;  // along x
  };
  std::vector<Edge> edges;
  Vector2d low = corners.front(), high = low;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d &from = corners[i], &to = corners[i + 1 < corners.size() ? i + 1 : 0];
    edges.push_back({from, to, std::min(from.x(), to.x()), std::max(from.x(), to.x())});
    low = low.cwiseMin(from);
    high = high.cwiseMax(from);
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.low < b.low; });
  const double touching = kTouching * (high - low).norm();
  // On which side of the edge the place is; 0 on it.
  const auto side_of = [touching](const Edge& edge, const Vector2d& place) {
    const Vector2d along = edge.to - edge.from;
    const double side = cross(along, place - edge.from);
    return std::abs(side) <= touching * along.norm() ? 0 : side > 0.0 ? 1 : -1;
  };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& a = edges[i];
    for (std::size_t k = i + 1; k < edges.size() && edges[k].low < a.high && tests > 0; ++k, --tests) {
      const Edge& b = edges[k];
      if (side_of(a, b.from) * side_of(a, b.to) < 0 && side_of(b, a.from) * side_of(b, a.to) < 0) return true;
    }
  }
  return false;
}

// Those that do not repeat the one before; the last one is before the first one.
std::vector<std::uint32_t> without_repeated(const Corners& corners) {
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (kept.empty() || corners[i] != corners[kept.back()]) kept.push_back(static_cast<std::uint32_t>(i));
  }
  while (kept.size() > 1 && corners[kept.front()] == corners[kept.back()]) kept.pop_back();
  return kept;
}

Vector3d triangle_normal(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return (b - a).cross(c - a);
}

// Each diagonal folds a quadrangle whose edges cross by half a turn. One that is only not flat is folded
// less.
bool is_crossed(const Corners& c) {
  const auto is_folded = [](const Vector3d& one, const Vector3d& other) {
    return one.dot(other) < -0.5 * one.norm() * other.norm();
  };
  return is_folded(triangle_normal(c[0], c[1], c[2]), triangle_normal(c[0], c[2], c[3])) &&
         is_folded(triangle_normal(c[1], c[2], c[3]), triangle_normal(c[1], c[3], c[0]));
}

// About the area by which the triangles of a polygon whose edges cross cover what it does not: of a bow tie's
// two, a half.
double wrong_of_crossed(const Corners& corners, const std::vector<PolygonTriangle>& triangles) {
  double twice = 0.0;
  for (const auto& [a, b, c] : triangles) twice += triangle_normal(corners[a], corners[b], corners[c]).norm();
  return 0.25 * twice;
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
  if (is_crossed(corners)) {
    polygon.fault = DividedPolygon::Fault::kCrossing;
    polygon.wrong_area = wrong_of_crossed(corners, polygon.triangles);
  }
  return polygon;
}

DividedPolygon divided_by_ears(const Corners& corners, const Vector3d& normal, long& tests) {
  const std::vector<Vector2d> flat = flattened(corners, normal);
  DividedPolygon polygon = EarClipper(flat, tests).divide();
  // Seen along the axis, an area is smaller than it is.
  polygon.wrong_area *= normal.norm() / normal.cwiseAbs().maxCoeff();
  if (polygon.fault != DividedPolygon::Fault::kNoTestsLeft && edges_cross(flat, tests)) {
    polygon.fault = DividedPolygon::Fault::kCrossing;
    polygon.wrong_area = std::max(polygon.wrong_area, wrong_of_crossed(corners, polygon.triangles));
  }
  return polygon;
}

}  // namespace

DividedPolygon divided(const Corners& corners, long& tests) {
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
    polygon = divided_by_ears(distinct, normal, tests);
  } else {
    // The corners lie on a line, or parts that turn in either way cancel each other, as in a figure of eight.
    polygon.triangles = {{0, 1, 2}};
    polygon.fault = DividedPolygon::Fault::kCrossing;
    for (std::size_t i = 2; i < distinct.size(); ++i)
      polygon.wrong_area += 0.5 * triangle_normal(distinct[0], distinct[i - 1], distinct[i]).norm();
  }
  for (PolygonTriangle& triangle : polygon.triangles) {
    for (std::uint32_t& corner : triangle) corner = kept[corner];
  }
  return polygon;
}

double area_of(const Corners& corners) {
  return 0.5 * normal_of(corners).norm();
}

std::vector<PolygonTriangle> PolygonDivider::divide(const Corners& corners, std::size_t number) {
  if (corners.size() == 3) {
    area_ += area_of(corners);
    return {{0, 1, 2}};
  }
  ++all_;
  const DividedPolygon polygon = divided(corners, tests_);
  area_ += std::max(area_of(corners), polygon.wrong_area);
  wrong_area_ += polygon.wrong_area;
  const bool is_untested = polygon.fault == DividedPolygon::Fault::kNoTestsLeft;
  if (is_untested) corners_of_untested_ = std::max(corners_of_untested_, corners.size());
  if (polygon.fault != DividedPolygon::Fault::kNone) {
    Count& count = is_untested ? untested_ : crossing_;
    if (count.polygons++ == 0) count.first = number;
  }
  return polygon.triangles;
}

std::string PolygonDivider::text_of(const Count& count, const char* unit, const std::string& why) const {
  if (count.polygons == 0) return {};
  return counted(count.polygons, "polygon") + " of " + std::to_string(all_) +
         " cannot be divided into triangles, the first in " + unit + " " + std::to_string(count.first) +
         ": " + why + "; ";
}

std::string PolygonDivider::loss(const char* unit) const {
  std::string text = text_of(crossing_, unit, "edges cross, or the corners lie on a line") +
                     text_of(untested_, unit,
                             "it would take too long, since the polygons have too many corners, up to " +
                                 std::to_string(corners_of_untested_));
  if (text.empty()) return {};
  const double share = area_ > 0.0 ? wrong_area_ / area_ : 0.0;
  char of_surface[64];
  std::snprintf(of_surface, sizeof of_surface, "about %.3g %% of the surface", 100.0 * share);
  const std::string remedy = "riangulate the mesh in the modelling tool and export it again";
  if (share <= kMaxShareWithoutArea) return text + of_surface + " is missing or wrong. T" + remedy;
  throw std::runtime_error(text + of_surface + " would be missing or wrong, at most " +
                           std::to_string(static_cast<int>(100.0 * kMaxShareWithoutArea)) + " % may be; t" +
                           remedy);
}

}  // namespace tumblesight::sim
