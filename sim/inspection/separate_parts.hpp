// Parts of a mesh that stand apart from the rest, with a gap around them: what a modelling tool has left
// behind, and parts whose support the model lacks.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

struct SeparatePart {
  std::vector<std::size_t> triangles;
  double area_m2 = 0.0;
  double reach_m = 0.0;  // of its farthest vertex, from the origin
  Eigen::AlignedBox3d box_trf_m;
  Eigen::Vector3d centre_trf_m = Eigen::Vector3d::Zero();  // of the box
};

// The parts that are more than about 2 % of the size of the mesh away from each other, the largest in area
// first. Parts that touch or penetrate each other are one, whether they share vertices or not. A mesh of one
// piece gives one part.
std::vector<SeparatePart> separate_parts(const TriangleMesh& mesh);

// Of parts as above, those that have less than 5 % of the area and enlarge the radius by more than 5 %, or
// lie more than three radii of the rest from its centre: the numbers of the parts. They cost resolution,
// since the image shows the whole radius.
std::vector<std::size_t> strays_of(const std::vector<SeparatePart>& parts);

}  // namespace tumblesight::sim
