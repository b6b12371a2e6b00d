#include "sim/world/target/panels.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "sim/world/target/groups.hpp"

namespace tumblesight::sim {
namespace {

// Of a part that counts as a panel without being marked, over the target's radius.
constexpr double kMaxThickness = 0.03;
constexpr double kMinWidth = 0.1;
constexpr double kMinReach = 0.75;           // of its farthest corner
constexpr double kMinCentre = 0.35;          // distance of its centre from the origin
constexpr double kMaxGap = 0.02;             // between two plates of one panel
constexpr double kParallel = 0.99;           // cosine between their normals
constexpr double kParallelEdges = 1e-3;      // length of the cross product of directions that count as one
constexpr std::size_t kMaxDirections = 200;  // tried for the smallest rectangle

Eigen::Vector3d area_vector_m2(const TriangleMesh& mesh, std::size_t triangle) {
  const auto c = mesh.corners_trf_m(triangle);
  return 0.5 * (c[1] - c[0]).cross(c[2] - c[0]);
}

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double length() const { return high - low; }
};

Extent extent_along(const TriangleMesh& mesh, const std::vector<std::size_t>& triangles,
                    const Eigen::Vector3d& axis) {
  Extent extent;
  for (const std::size_t triangle : triangles) {
    for (const Eigen::Vector3d& corner : mesh.corners_trf_m(triangle)) extent.add(axis.dot(corner));
  }
  return extent;
}

// The normal of the largest triangle.
Eigen::Vector3d normal_of(const TriangleMesh& mesh, const std::vector<std::size_t>& triangles) {
  Eigen::Vector3d largest = Eigen::Vector3d::Zero();
  for (const std::size_t triangle : triangles) {
    const Eigen::Vector3d area = area_vector_m2(mesh, triangle);
    if (area.squaredNorm() > largest.squaredNorm()) largest = area;
  }
  return largest.normalized();
}

// Unit vectors along the edges in the plane across `normal`, no two of them parallel.
std::vector<Eigen::Vector3d> edge_directions(const TriangleMesh& mesh,
                                             const std::vector<std::size_t>& triangles,
                                             const Eigen::Vector3d& normal) {
  std::vector<Eigen::Vector3d> directions;
  for (const std::size_t triangle : triangles) {
    const auto c = mesh.corners_trf_m(triangle);
    for (int i = 0; i < 3 && directions.size() < kMaxDirections; ++i) {
      const Eigen::Vector3d edge = (c[(i + 1) % 3] - c[i]).normalized();
      if (std::abs(edge.dot(normal)) > 1.0 - kParallel) continue;
      const auto same = [&](const Eigen::Vector3d& d) { return d.cross(edge).norm() < kParallelEdges; };
      if (std::none_of(directions.begin(), directions.end(), same)) directions.push_back(edge);
    }
  }
  return directions;
}

struct Rectangle {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  // of its sides
  Eigen::Vector3d across = Eigen::Vector3d::UnitY();
  double length_m = 0.0;  // along these
  double width_m = 0.0;
  Eigen::Vector3d centre_trf_m = Eigen::Vector3d::Zero();
};

Rectangle smallest_rectangle(const TriangleMesh& mesh, const std::vector<std::size_t>& triangles,
                             const Eigen::Vector3d& normal) {
  Rectangle best;
  double best_area_m2 = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& axis : edge_directions(mesh, triangles, normal)) {
    const Eigen::Vector3d across = normal.cross(axis).normalized();
    const Extent u = extent_along(mesh, triangles, axis);
    const Extent v = extent_along(mesh, triangles, across);
    if (u.length() * v.length() >= best_area_m2) continue;
    best_area_m2 = u.length() * v.length();
    const Extent n = extent_along(mesh, triangles, normal);
    best = {axis, across, u.length(), v.length(),
            0.5 * ((u.low + u.high) * axis + (v.low + v.high) * across + (n.low + n.high) * normal)};
  }
  return best;
}

Panel panel_of(const TriangleMesh& mesh, const std::vector<std::size_t>& triangles) {
  Panel panel;
  panel.triangles = triangles;
  panel.normal_trf = normal_of(mesh, triangles);
  const Rectangle rectangle = smallest_rectangle(mesh, triangles, panel.normal_trf);
  panel.centre_trf_m = rectangle.centre_trf_m;
  const bool along =
      std::abs(rectangle.axis.dot(panel.centre_trf_m)) >= std::abs(rectangle.across.dot(panel.centre_trf_m));
  panel.hinge_trf = along ? rectangle.axis : rectangle.across;
  if (panel.hinge_trf.dot(panel.centre_trf_m) < 0.0) panel.hinge_trf = -panel.hinge_trf;
  return panel;
}

bool looks_like_a_panel(const TriangleMesh& mesh, const std::vector<std::size_t>& part, double radius_m) {
  const Eigen::Vector3d normal = normal_of(mesh, part);
  if (extent_along(mesh, part, normal).length() > kMaxThickness * radius_m) return false;
  double reach_m = 0.0;
  for (const std::size_t triangle : part) {
    for (const Eigen::Vector3d& corner : mesh.corners_trf_m(triangle))
      reach_m = std::max(reach_m, corner.norm());
  }
  if (reach_m < kMinReach * radius_m) return false;
  const Rectangle rectangle = smallest_rectangle(mesh, part, normal);
  return std::min(rectangle.length_m, rectangle.width_m) >= kMinWidth * radius_m &&
         rectangle.centre_trf_m.norm() >= kMinCentre * radius_m;
}

// A flat part and the box around it, along the axes of the TRF.
struct Plate {
  std::vector<std::size_t> triangles;
  Eigen::Vector3d normal_trf;
  Eigen::AlignedBox3d box_trf_m;
};

Plate plate_of(const TriangleMesh& mesh, const std::vector<std::size_t>& part) {
  Plate plate{part, normal_of(mesh, part), {}};
  for (const std::size_t triangle : part) {
    for (const Eigen::Vector3d& corner : mesh.corners_trf_m(triangle)) plate.box_trf_m.extend(corner);
  }
  return plate;
}

bool touch(const Plate& a, const Plate& b, double radius_m) {
  return a.box_trf_m.exteriorDistance(b.box_trf_m) < kMaxGap * radius_m;
}

bool are_parallel(const Plate& a, const Plate& b) {
  return std::abs(a.normal_trf.dot(b.normal_trf)) > kParallel;
}

}  // namespace

std::vector<std::vector<std::size_t>> connected_parts(const TriangleMesh& mesh) {
  // One node per place and mark.
  std::map<std::array<float, 3>, std::size_t> place_of;
  std::vector<std::size_t> place(mesh.vertices_trf_m.size());
  for (std::size_t i = 0; i < place.size(); ++i) {
    const Eigen::Vector3f& v = mesh.vertices_trf_m[i];
    place[i] = place_of.try_emplace({v.x(), v.y(), v.z()}, place_of.size()).first->second;
  }
  const auto node = [&](std::size_t triangle, int corner) {
    const bool marked = !mesh.is_panel.empty() && mesh.is_panel[triangle] != 0;
    return 2 * place[mesh.triangles[triangle][corner]] + (marked ? 1 : 0);
  };
  Groups groups(2 * place_of.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    groups.join(node(i, 0), node(i, 1));
    groups.join(node(i, 0), node(i, 2));
  }
  std::map<std::size_t, std::size_t> part_of_group;
  std::vector<std::vector<std::size_t>> parts;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [entry, is_new] = part_of_group.try_emplace(groups.of(node(i, 0)), parts.size());
    if (is_new) parts.emplace_back();
    parts[entry->second].push_back(i);
  }
  return parts;
}

double area_m2(const TriangleMesh& mesh, const std::vector<std::size_t>& triangles) {
  double sum_m2 = 0.0;
  for (const std::size_t triangle : triangles) sum_m2 += area_vector_m2(mesh, triangle).norm();
  return sum_m2;
}

std::vector<Panel> find_panels(const TriangleMesh& mesh) {
  const double radius_m = mesh.radius_m();
  std::vector<Plate> plates;
  for (const std::vector<std::size_t>& part : connected_parts(mesh)) {
    const bool is_panel =
        mesh.is_panel.empty() ? looks_like_a_panel(mesh, part, radius_m) : mesh.is_panel[part.front()] != 0;
    if (is_panel) plates.push_back(plate_of(mesh, part));
  }
  Groups groups(plates.size());
  for (std::size_t a = 0; a < plates.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const bool one_panel = !mesh.is_panel.empty() || are_parallel(plates[a], plates[b]);
      if (one_panel && touch(plates[a], plates[b], radius_m)) groups.join(a, b);
    }
  }
  std::map<std::size_t, std::vector<std::size_t>> triangles_of;
  for (std::size_t i = 0; i < plates.size(); ++i) {
    std::vector<std::size_t>& triangles = triangles_of[groups.of(i)];
    triangles.insert(triangles.end(), plates[i].triangles.begin(), plates[i].triangles.end());
  }
  std::vector<Panel> panels;
  for (const auto& [group, triangles] : triangles_of) panels.push_back(panel_of(mesh, triangles));
  return panels;
}

}  // namespace tumblesight::sim
