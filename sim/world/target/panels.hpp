// Panels: which parts of a surface are solar panels, and how they are hinged.
//
// A panel is a connected part (triangles that share a corner). Shipped targets mark theirs by construction.
// In a file, the parts whose material has "solar" or "panel" in its name are panels. Without such names, a
// part counts as one if it is flat, at least a tenth of the target's radius wide, has its centre well outside
// the origin and reaches out nearly as far as the target does. Marked parts, or parallel plates, that touch
// or nearly touch, such as a panel and its cells, are one panel. Limit: a panel that shares corners
// with other parts is not found by its shape.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// The triangles of each connected part, as indices into mesh.triangles; the parts in the order of their first
// triangles. Corners at exactly the same place are one, except between marked triangles and others.
std::vector<std::vector<std::size_t>> connected_parts(const TriangleMesh& mesh);
// In square metres, both sides of a closed part.
double area_m2(const TriangleMesh& mesh, const std::vector<std::size_t>& triangles);

struct Panel {
  std::vector<std::size_t> triangles;
  Eigen::Vector3d centre_trf_m;
  Eigen::Vector3d normal_trf;  // unit, of either sign
  Eigen::Vector3d hinge_trf;   // unit: the panel turns about this axis through its centre
};

// Empty if the target has none. The hinge is the edge direction of the smallest rectangle around the panel
// that points away from the origin.
std::vector<Panel> find_panels(const TriangleMesh& mesh);

}  // namespace tumblesight::sim
