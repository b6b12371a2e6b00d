#include "sim/inspection/hiding_part.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "sim/quantization/outside_views.hpp"
#include "sim/world/target/panels.hpp"

namespace tumblesight::sim {
namespace {

using Eigen::Vector3d;
using Triangles = std::vector<std::size_t>;

constexpr double kTolerance = 1e-4;            // of the width of a part
constexpr double kFlat = 1e-3;                 // thickness over width
constexpr double kPlaneArea = 0.5;             // of the whole
constexpr double kSeen = 0.5;                  // of the triangles of a part
constexpr std::size_t kMostOfACover = 20'000;  // of a cover: domes have a few thousand
constexpr int kSteps = 4;                      // of the points on a triangle, per side

struct Plane {
  Vector3d normal;
  double offset = 0.0;
  double outside_by(const Vector3d& point) const { return normal.dot(point) - offset; }
};

Vector3d corner(const TriangleMesh& mesh, std::size_t triangle, std::size_t which) {
  return mesh.vertices_trf_m[mesh.triangles[triangle][which]].cast<double>();
}

Eigen::AlignedBox3d box_of(const TriangleMesh& mesh, const Triangles& triangles) {
  Eigen::AlignedBox3d box;
  for (const std::size_t triangle : triangles) {
    for (std::size_t i = 0; i < 3; ++i) box.extend(corner(mesh, triangle, i));
  }
  return box;
}

// Every edge belongs to two triangles, by the places of its ends.
bool is_closed(const TriangleMesh& mesh, const Triangles& part) {
  using Place = std::array<float, 3>;
  std::map<std::pair<Place, Place>, int> edges;
  const auto place = [&](std::size_t triangle, std::size_t which) {
    const Eigen::Vector3f& v = mesh.vertices_trf_m[mesh.triangles[triangle][which]];
    return Place{v.x(), v.y(), v.z()};
  };
  for (const std::size_t triangle : part) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Place a = place(triangle, i), b = place(triangle, (i + 1) % 3);
      ++edges[{std::min(a, b), std::max(a, b)}];
    }
  }
  return std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second % 2 == 0; });
}

// The planes of its triangles, normals outwards; empty if the part is not convex.
std::vector<Plane> planes_if_convex(const TriangleMesh& mesh, const Triangles& part, double tolerance_m) {
  std::vector<Plane> planes;
  const Vector3d middle = box_of(mesh, part).center();
  for (const std::size_t triangle : part) {
    const Vector3d a = corner(mesh, triangle, 0);
    const Vector3d across = (corner(mesh, triangle, 1) - a).cross(corner(mesh, triangle, 2) - a);
    if (!(across.norm() > 0.0)) continue;
    Plane plane{across.normalized(), 0.0};
    plane.offset = plane.normal.dot(a);
    if (plane.outside_by(middle) > 0.0) plane = {-plane.normal, -plane.offset};
    for (const std::size_t other : part) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (plane.outside_by(corner(mesh, other, i)) > tolerance_m) return {};
      }
    }
    planes.push_back(plane);
  }
  return planes;
}

double area_of(const TriangleMesh& mesh, std::size_t triangle) {
  const Vector3d a = corner(mesh, triangle, 0);
  return 0.5 * (corner(mesh, triangle, 1) - a).cross(corner(mesh, triangle, 2) - a).norm();
}

// Of points spread over a triangle, the share that is inside all planes.
double share_inside(const TriangleMesh& mesh, std::size_t triangle, const std::vector<Plane>& planes,
                    double tolerance_m) {
  const Vector3d a = corner(mesh, triangle, 0), b = corner(mesh, triangle, 1), c = corner(mesh, triangle, 2);
  int inside = 0, points = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps - i; ++j, ++points) {
      const Vector3d point = a + (i + 1.0 / 3.0) / kSteps * (b - a) + (j + 1.0 / 3.0) / kSteps * (c - a);
      const bool is_inside = std::all_of(planes.begin(), planes.end(), [&](const Plane& plane) {
        return plane.outside_by(point) < -tolerance_m;
      });
      if (is_inside) ++inside;
    }
  }
  return static_cast<double>(inside) / points;
}

struct Shares {
  double rest_m2 = 0.0, inside_m2 = 0.0;
};

Shares shares_of(const TriangleMesh& mesh, const Triangles& part, const std::vector<Plane>& planes,
                 double tolerance_m) {
  std::vector<std::uint8_t> is_of_part(mesh.triangles.size(), 0);
  for (const std::size_t triangle : part) is_of_part[triangle] = 1;
  Shares shares;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (is_of_part[i] != 0) continue;
    const double area_m2 = area_of(mesh, i);
    shares.rest_m2 += area_m2;
    shares.inside_m2 += area_m2 * share_inside(mesh, i, planes, tolerance_m);
  }
  return shares;
}

// How much of the rest a closed convex part hides; nothing for other parts.
Shares hidden_by(const TriangleMesh& mesh, const Triangles& part, double width_m) {
  constexpr std::size_t kTetrahedron = 4;
  if (part.size() < kTetrahedron || part.size() > kMostOfACover) return {};
  const std::vector<Plane> planes = planes_if_convex(mesh, part, kTolerance * width_m);
  if (planes.size() < kTetrahedron || !is_closed(mesh, part)) return {};
  return shares_of(mesh, part, planes, kTolerance * width_m);
}

bool is_seen(const TriangleMesh& mesh, const Triangles& part) {
  TriangleMesh unit = mesh;  // the sensor model does not see far
  for (Eigen::Vector3f& vertex : unit.vertices_trf_m) vertex /= mesh.radius_m();
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

std::optional<HidingPart> hiding_part(const TriangleMesh& mesh, const std::optional<MarkerCube>& marker) {
  const std::vector<Triangles> parts = connected_parts(mesh);
  if (parts.size() < 2) return std::nullopt;
  HidingPart most;
  for (const Triangles& part : parts) {
    HidingPart found{part, box_of(mesh, part).sizes().maxCoeff(), 0.0,
                     0.0,  marker && marker->triangles == part,   false};
    const Shares shares = hidden_by(mesh, part, found.width_m);
    if (!(shares.rest_m2 > 0.0)) continue;
    found.rest_m2 = shares.rest_m2;
    found.hidden = shares.inside_m2 / shares.rest_m2;
    if (found.hidden > std::max(most.hidden, found.is_marker ? kHiddenByMarker : kHiddenByCover))
      most = found;
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
