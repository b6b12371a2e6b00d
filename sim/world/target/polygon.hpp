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
  enum class Fault { kNone, kCrossing, kNoTestsLeft };

  std::vector<PolygonTriangle> triangles;  // numbers of corners; they turn the way the polygon does
  Fault fault = Fault::kNone;              // kCrossing: edges cross, or the corners lie on a line
  double wrong_area = 0.0;                 // about, of the part that is missing or wrong
};

// Divides a polygon, which may be concave and not quite flat, as seen along its normal. One whose edges cross
// may be divided in part only, or cover what it does not. A corner that repeats the one before it is left
// out. `corners`: at least 3, at most kMostCorners, all finite. `tests`: how many tests of a corner or an
// edge the polygon may take; lowered by those that it took.
inline constexpr std::size_t kMostCorners = 5000;
DividedPolygon divided(const std::vector<Eigen::Vector3d>& corners, long& tests);

double area_of(const std::vector<Eigen::Vector3d>& corners);

// Divides the polygons of a file, and counts what became of them.
class PolygonDivider {
 public:
  // `number`: of the line or face, for messages. One of three corners is not touched.
  std::vector<PolygonTriangle> divide(const std::vector<Eigen::Vector3d>& corners, std::size_t number);

  // Empty if nothing is missing. `unit`: "line" or "face". Throws std::runtime_error if more than
  // kMaxShareWithoutArea of the surface is missing or wrong.
  std::string loss(const char* unit) const;

 private:
  struct Count {
    std::size_t polygons = 0;
    std::size_t first = 0;  // number of its line or face
  };
  std::string text_of(const Count& count, const char* unit, const std::string& why) const;

  long tests_ = 500'000'000;  // a few seconds
  std::size_t all_ = 0;       // of more than three corners
  Count crossing_, untested_;
  std::size_t corners_of_untested_ = 0;
  double wrong_area_ = 0.0;
  double area_ = 0.0;  // of all faces
};

}  // namespace tumblesight::sim
