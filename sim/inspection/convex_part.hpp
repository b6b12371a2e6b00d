// A closed convex part of a mesh, and which places are inside it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

class ConvexPart {
 public:
  // Empty if the part is open, has a dent of more than the tolerance, or has more than 20,000 triangles
  // (domes have a few thousand): the time grows with their square.
  static std::optional<ConvexPart> of(const TriangleMesh& mesh, const std::vector<std::size_t>& part,
                                      double tolerance_m);
  // By more than the tolerance.
  bool holds(const Eigen::Vector3d& point_trf_m) const;

 private:
  struct Plane {
    Eigen::Vector3d normal;  // outwards
    double offset_m = 0.0;
    double outside_by_m(const Eigen::Vector3d& point) const { return normal.dot(point) - offset_m; }
  };
  static std::vector<Plane> planes_if_convex(const TriangleMesh& mesh, const std::vector<std::size_t>& part,
                                             double tolerance_m);

  std::vector<Plane> planes_;
  double tolerance_m_ = 0.0;
};

}  // namespace tumblesight::sim
