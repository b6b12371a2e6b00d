#include "sim/inspection/hiding_part.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "sim/inspection/convex_part.hpp"
#include "sim/surface/outside_views.hpp"
#include "sim/world/target/panels.hpp"

namespace tumblesight::sim {
namespace {

using Eigen::Vector3d;
using Triangles = std::vector<std::size_t>;

constexpr double kTolerance = 1e-4;      // of the width of a part
constexpr double kFlat = 1e-3;           // thickness over width
constexpr double kPlaneArea = 0.5;       // of the whole
constexpr double kSeen = 0.5;            // of the triangles of a part
constexpr std::size_t kMostBoxes = 256;  // compared with those of all other parts, the largest first
constexpr std::size_t kPoints = 4000;    // over all other parts, to see how much of them is inside one

Eigen::AlignedBox3d box_of(const TriangleMesh& mesh, const Triangles& triangles) {
  Eigen::AlignedBox3d box;
  for (const std::size_t triangle : triangles) {
    for (const Vector3d& corner : mesh.corners_trf_m(triangle)) box.extend(corner);
  }
  return box;
}

struct PartBox {
  Eigen::AlignedBox3d box;
  double area_m2 = 0.0;
};

std::vector<PartBox> boxes_of(const TriangleMesh& mesh, const std::vector<Triangles>& parts) {
  std::vector<PartBox> boxes;
  boxes.reserve(parts.size());
  for (const Triangles& part : parts) boxes.push_back({box_of(mesh, part), area_m2(mesh, part)});
  return boxes;
}

// Of the area of all other parts, the share of those whose boxes meet the box of this one.
double largest_share(const std::vector<PartBox>& boxes, std::size_t part) {
  double met_m2 = 0.0, rest_m2 = 0.0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (i == part) continue;
    rest_m2 += boxes[i].area_m2;
    if (boxes[part].box.intersects(boxes[i].box)) met_m2 += boxes[i].area_m2;
  }
  return rest_m2 > 0.0 ? met_m2 / rest_m2 : 0.0;
}

double area_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto [a, b, c] = mesh.corners_trf_m(triangle);
  return 0.5 * (b - a).cross(c - a).norm();
}

// The R2 sequence: any number of consecutive points is spread evenly over the triangle.
Vector3d point_on(const TriangleMesh& mesh, std::size_t triangle, std::size_t number) {
  double whole = 0.0;
  double u = std::modf(0.5 + 0.7548776662466927 * static_cast<double>(number), &whole);
  double v = std::modf(0.5 + 0.5698402909980532 * static_cast<double>(number), &whole);
  if (u + v > 1.0) {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  const auto [a, b, c] = mesh.corners_trf_m(triangle);
  return a + u * (b - a) + v * (c - a);
}

// All triangles except those of a part.
struct Rest {
  Triangles triangles;
  double area_m2 = 0.0;
};

Rest rest_of(const TriangleMesh& mesh, const Triangles& part) {
  std::vector<std::uint8_t> is_of_part(mesh.triangles.size(), 0);
  for (const std::size_t triangle : part) is_of_part[triangle] = 1;
  Rest rest;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (is_of_part[i] != 0) continue;
    rest.triangles.push_back(i);
    rest.area_m2 += area_of(mesh, i);
  }
  return rest;
}

// By points that are spread evenly over the area.
double share_inside(const TriangleMesh& mesh, const Rest& rest, const ConvexPart& cover) {
  const double step_m2 = rest.area_m2 / static_cast<double>(kPoints);
  double passed_m2 = 0.0;
  std::size_t points = 0, inside = 0;
  for (const std::size_t triangle : rest.triangles) {
    passed_m2 += area_of(mesh, triangle);
    for (; points < kPoints && (static_cast<double>(points) + 0.5) * step_m2 < passed_m2; ++points) {
      if (cover.holds(point_on(mesh, triangle, points))) ++inside;
    }
  }
  return points > 0 ? static_cast<double>(inside) / static_cast<double>(points) : 0.0;
}

// Nothing is hidden by parts that are open or not convex.
HidingPart hidden_by(const TriangleMesh& mesh, const Triangles& part) {
  HidingPart found;
  found.triangles = part;
  found.width_m = box_of(mesh, part).sizes().maxCoeff();
  const std::optional<ConvexPart> cover = ConvexPart::of(mesh, part, kTolerance * found.width_m);
  if (!cover) return found;
  const Rest rest = rest_of(mesh, part);
  found.rest_m2 = rest.area_m2;
  found.hidden = share_inside(mesh, rest, *cover);
  return found;
}

bool is_seen(const TriangleMesh& mesh, const Triangles& part) {
  TriangleMesh unit = mesh;  // the sensor model does not see far
  const auto radius_m = static_cast<float>(mesh.radius_m());
  for (Eigen::Vector3f& vertex : unit.vertices_trf_m) vertex /= radius_m;
  const OuterSurface outer = outer_surface(unit);
  const auto seen = std::count_if(part.begin(), part.end(),
                                  [&](std::size_t triangle) { return outer.is_seen[triangle] != 0; });
  return static_cast<double>(seen) > kSeen * static_cast<double>(part.size());
}

// Flat along an axis of the frame, and the rest stands on one side of it and within its outline.
bool is_ground(const TriangleMesh& mesh, const Triangles& part, const Triangles& rest) {
  const Eigen::AlignedBox3d box = box_of(mesh, part), others = box_of(mesh, rest);
  int thin = 0;
  const double thickness_m = box.sizes().minCoeff(&thin), width_m = box.sizes().maxCoeff();
  if (thickness_m > kFlat * width_m ||
      area_m2(mesh, part) < kPlaneArea * (area_m2(mesh, part) + area_m2(mesh, rest)))
    return false;
  const double tolerance_m = 0.01 * width_m;
  const bool one_side = others.min()[thin] > box.max()[thin] - tolerance_m ||
                        others.max()[thin] < box.min()[thin] + tolerance_m;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis != thin && (others.min()[axis] < box.min()[axis] || others.max()[axis] > box.max()[axis]))
      return false;
  }
  return one_side;
}

}  // namespace

std::vector<std::size_t> possible_covers(const TriangleMesh& mesh, const std::vector<Triangles>& parts,
                                         const std::optional<MarkerCube>& marker) {
  const std::vector<PartBox> boxes = boxes_of(mesh, parts);
  const auto is_marker = [&](std::size_t part) { return marker && marker->triangles == parts[part]; };
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return boxes[a].box.volume() > boxes[b].box.volume();
  });
  std::stable_partition(order.begin(), order.end(), is_marker);
  order.resize(std::min(order.size(), kMostBoxes));
  std::vector<std::size_t> covers;
  for (const std::size_t part : order) {
    const double enough = is_marker(part) ? kHiddenByMarker : kHiddenByCover;
    if (covers.size() < kMostCovers && largest_share(boxes, part) > enough) covers.push_back(part);
  }
  return covers;
}

std::optional<HidingPart> hiding_part(const TriangleMesh& mesh, const std::optional<MarkerCube>& marker) {
  const std::vector<Triangles> parts = connected_parts(mesh);
  if (parts.size() < 2) return std::nullopt;
  HidingPart most;
  for (const std::size_t part : possible_covers(mesh, parts, marker)) {
    HidingPart found = hidden_by(mesh, parts[part]);
    found.is_marker = marker && marker->triangles == parts[part];
    if (found.hidden > std::max(most.hidden, found.is_marker ? kHiddenByMarker : kHiddenByCover))
      most = std::move(found);
  }
  if (most.hidden > 0.0 && is_seen(mesh, most.triangles)) return most;
  const auto largest = std::max_element(
      parts.begin(), parts.end(),
      [&](const Triangles& a, const Triangles& b) { return area_m2(mesh, a) < area_m2(mesh, b); });
  Triangles rest;
  for (auto part = parts.begin(); part != parts.end(); ++part) {
    if (part != largest) rest.insert(rest.end(), part->begin(), part->end());
  }
  if (!is_ground(mesh, *largest, rest)) return std::nullopt;
  return HidingPart{*largest, box_of(mesh, *largest).sizes().maxCoeff(), 0.0, area_m2(mesh, rest), false,
                    true};
}

}  // namespace tumblesight::sim
