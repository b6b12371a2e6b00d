// The cube of 12 triangles about the origin that some exporters add to mark it (NASA's name it `_root`). The
// body of a CubeSat may look the same.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

struct MarkerCube {
  std::vector<std::size_t> triangles;
  double side_m = 0.0;
  double outer_share = 1.0;  // of the outer surface, which is lost without the cube
};

// Of several the largest. A mesh that is a cube and nothing else has none.
std::optional<MarkerCube> marker_cube(const TriangleMesh& mesh);

// For MarkerCube::outer_share: 0 for a cube inside the body, or with its faces in those of the body. `mesh`
// has no parts far away, as their distance would make the views coarse.
double outer_share_of(const TriangleMesh& mesh, const MarkerCube& cube);

}  // namespace tumblesight::sim
