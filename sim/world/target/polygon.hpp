// Polygons of mesh files, divided into triangles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tumblesight::sim {

using PolygonTriangle = std::array<std::uint32_t, 3>;

struct DividedPolygon {
  std::vector<PolygonTriangle> triangles;  // numbers of corners; they turn the way the polygon does
  double missing_area = 0.0;               // of the part that cannot be divided
  bool is_whole = true;
};

// Divides a polygon, which may be concave and not quite flat, as seen along its normal. One whose edges cross
// may be divided in part only. A corner that repeats the one before it is left out. `corners`: at least 3, at
// most kMostCorners, all finite.
inline constexpr std::size_t kMostCorners = 5000;
DividedPolygon divided(const std::vector<Eigen::Vector3d>& corners);

double area_of(const std::vector<Eigen::Vector3d>& corners);

// What became of the polygons of a file.
struct PolygonCount {
  std::size_t all = 0;  // of more than three corners
  std::size_t not_whole = 0;
  std::size_t first = 0;  // number of its line or face
  double missing_area = 0.0;
  double area = 0.0;  // of all faces

  void add(const std::vector<Eigen::Vector3d>& corners, const DividedPolygon& polygon, std::size_t number);
  // Empty if nothing is missing. `unit`: "line" or "face".
  std::string loss(const char* unit) const;
};

}  // namespace tumblesight::sim
