#include "sim/inspection/separate_parts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "sim/world/target/groups.hpp"
#include "sim/world/target/panels.hpp"

namespace tumblesight::sim {
namespace {

using Eigen::Vector3f;

constexpr float kCellShare = 0.01F;      // of the diagonal of the mesh's box
constexpr double kMaxStrayArea = 0.05;   // of the whole area
constexpr double kMinStrayReach = 1.05;  // its reach over that of the rest
constexpr double kFarReach = 3.0;        // the same about the centre of the rest

// The cells of a grid that the surface passes through. Cells side by side belong to one group.
class Cells {
 public:
  Cells(const Eigen::AlignedBox3f& box, float cell_m) : origin_(box.min()), cell_m_(cell_m) {}

  std::size_t at(const Vector3f& point) {
    const Vector3f scaled = (point - origin_) / cell_m_;
    const std::array<std::int64_t, 3> place{std::lround(scaled.x()) + 1, std::lround(scaled.y()) + 1,
                                            std::lround(scaled.z()) + 1};
    const auto [entry, is_new] = cells_.try_emplace(key(place), groups_count_);
    if (!is_new) return entry->second;
    const std::size_t cell = groups_.add();
    ++groups_count_;
    join_neighbours(place, cell);
    return cell;
  }
  void join(std::size_t a, std::size_t b) { groups_.join(a, b); }
  std::size_t group(std::size_t cell) { return groups_.of(cell); }

 private:
  static std::uint64_t key(const std::array<std::int64_t, 3>& place) {
    constexpr int kBits = 20;
    return static_cast<std::uint64_t>(place[0]) << (2 * kBits) |
           static_cast<std::uint64_t>(place[1]) << kBits | static_cast<std::uint64_t>(place[2]);
  }
  void join_neighbours(const std::array<std::int64_t, 3>& place, std::size_t cell) {
    for (int i = 0; i < 27; ++i) {
      const auto found =
          cells_.find(key({place[0] + i % 3 - 1, place[1] + i / 3 % 3 - 1, place[2] + i / 9 - 1}));
      if (found != cells_.end()) groups_.join(found->second, cell);
    }
  }

  Vector3f origin_;
  float cell_m_;
  Groups groups_{0};
  std::size_t groups_count_ = 0;
  std::unordered_map<std::uint64_t, std::size_t> cells_;
};

Eigen::AlignedBox3f box_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Vector3f& v : mesh.vertices_trf_m) box.extend(v);
  return box;
}

int steps_of(float length_m, float cell_m) {
  return std::max(1, static_cast<int>(std::ceil(length_m / cell_m)));
}

// Marks the cells that a triangle passes through, with a point per cell, in rows along its shortest side: a
// thin triangle has few per row. Returns one of the cells.
std::size_t add_triangle(Vector3f a, Vector3f b, Vector3f c, float cell_m, Cells& cells) {
  if ((c - a).norm() < (c - b).norm()) std::swap(a, b);
  if ((b - a).norm() < (c - b).norm()) std::swap(a, c);
  const float shortest_m = (c - b).norm();
  const int rows = steps_of(std::max((b - a).norm(), (c - a).norm()), cell_m);
  const std::size_t first = cells.at(a);
  for (int i = 1; i <= rows; ++i) {
    const float u = static_cast<float>(i) / static_cast<float>(rows);
    const Vector3f from = a + u * (b - a), across = u * (c - b);
    const int steps = steps_of(u * shortest_m, cell_m);
    for (int j = 0; j <= steps; ++j)
      cells.join(first, cells.at(from + static_cast<float>(j) / static_cast<float>(steps) * across));
  }
  return first;
}

SeparatePart part_of(const TriangleMesh& mesh, std::vector<std::size_t> triangles) {
  SeparatePart part;
  part.area_m2 = area_m2(mesh, triangles);
  for (const std::size_t triangle : triangles) {
    for (const std::uint32_t corner : mesh.triangles[triangle]) {
      const Eigen::Vector3d place = mesh.vertices_trf_m[corner].cast<double>();
      part.reach_m = std::max(part.reach_m, place.norm());
      part.box_trf_m.extend(place);
    }
  }
  part.centre_trf_m = part.box_trf_m.center();
  part.triangles = std::move(triangles);
  return part;
}

}  // namespace

std::vector<SeparatePart> separate_parts(const TriangleMesh& mesh) {
  const Eigen::AlignedBox3f box = box_of(mesh);
  const float cell_m = kCellShare * box.diagonal().norm();
  Cells cells(box, cell_m);
  std::vector<std::size_t> cell_of;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto& v = mesh.vertices_trf_m;
    cell_of.push_back(add_triangle(v[a], v[b], v[c], cell_m, cells));
  }
  std::unordered_map<std::size_t, std::size_t> number_of;
  std::vector<std::vector<std::size_t>> triangles;
  for (std::size_t i = 0; i < cell_of.size(); ++i) {
    const auto [entry, is_new] = number_of.try_emplace(cells.group(cell_of[i]), triangles.size());
    if (is_new) triangles.emplace_back();
    triangles[entry->second].push_back(i);
  }
  std::vector<SeparatePart> parts;
  for (std::vector<std::size_t>& of_part : triangles) parts.push_back(part_of(mesh, std::move(of_part)));
  std::stable_sort(parts.begin(), parts.end(),
                   [](const SeparatePart& a, const SeparatePart& b) { return a.area_m2 > b.area_m2; });
  return parts;
}

std::vector<std::size_t> strays_of(const std::vector<SeparatePart>& parts) {
  double area_m2 = 0.0;
  for (const SeparatePart& part : parts) area_m2 += part.area_m2;
  const auto is_small = [area_m2](const SeparatePart& part) {
    return part.area_m2 < kMaxStrayArea * area_m2;
  };
  double reach_m = 0.0;  // of what cannot be a stray
  Eigen::AlignedBox3d rest;
  for (const SeparatePart& part : parts) {
    if (is_small(part)) continue;
    reach_m = std::max(reach_m, part.reach_m);
    rest.extend(part.box_trf_m);
  }
  // With an origin far away, a part that lies apart enlarges the radius about it by little or not at all.
  const auto is_far = [&rest](const SeparatePart& part) {
    return (part.box_trf_m.center() - rest.center()).norm() > kFarReach * 0.5 * rest.diagonal().norm();
  };
  std::vector<std::size_t> strays;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (is_small(parts[i]) && (parts[i].reach_m > kMinStrayReach * reach_m || is_far(parts[i])))
      strays.push_back(i);
  }
  return reach_m > 0.0 ? strays : std::vector<std::size_t>{};
}

}  // namespace tumblesight::sim
