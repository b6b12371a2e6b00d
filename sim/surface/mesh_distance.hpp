// MeshDistance: how far a point is from the surface of a mesh (Embree's closest-point query).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

class EmbreeScene;

// The point of the triangle a, b, c that is closest to `point`. The triangle may have no area.
Eigen::Vector3f closest_point(const Eigen::Vector3f& point, const Eigen::Vector3f& a,
                              const Eigen::Vector3f& b, const Eigen::Vector3f& c);

struct ClosestPoint {
  float distance_m;  // infinity for a mesh without triangles
  std::uint32_t triangle;
  Eigen::Vector3f point_m;
};

class MeshDistance {
 public:
  // The mesh must outlive this object. Throws std::runtime_error if Embree refuses it.
  explicit MeshDistance(const TriangleMesh& mesh);
  ~MeshDistance();
  MeshDistance(const MeshDistance&) = delete;
  MeshDistance& operator=(const MeshDistance&) = delete;

  ClosestPoint closest(const Eigen::Vector3f& point_m) const;
  float distance_m(const Eigen::Vector3f& point_m) const { return closest(point_m).distance_m; }
  // Of the point that is farthest away; 0 without points.
  float largest_distance_m(const std::vector<Eigen::Vector3f>& points_m) const;

 private:
  const TriangleMesh& mesh_;
  std::unique_ptr<EmbreeScene> scene_;
};

}  // namespace tumblesight::sim
