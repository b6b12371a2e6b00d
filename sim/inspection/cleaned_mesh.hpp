// A cleaned copy of a mesh: without what a modelling tool has left behind, about a chosen origin.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "sim/inspection/mesh_inspection.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// The triangles whose numbers are not in `left_out`, and their vertices.
TriangleMesh without(const TriangleMesh& mesh, const std::vector<std::size_t>& left_out);
std::vector<std::size_t> triangles_of_strays(const MeshInspection& found);

struct CleaningOptions {
  std::optional<Eigen::Vector3d> origin_trf_m;  // empty: the centre of the outer surface
  bool keep_strays = false;
};

struct CleanedMesh {
  TriangleMesh mesh;
  Eigen::Vector3d moved_m = Eigen::Vector3d::Zero();  // added to every vertex
  std::size_t repeated = 0;                           // triangles that were left out, by reason
  std::size_t marker = 0;
  std::size_t strays = 0;
};

// `found`: of this mesh.
CleanedMesh cleaned(const TriangleMesh& mesh, const MeshInspection& found, const CleaningOptions& options);

}  // namespace tumblesight::sim
