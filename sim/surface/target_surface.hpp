// The two sections of a model image with the target's surface (points: surface_samples.hpp, triangles:
// surface_mesh.hpp), both made from one mesh.
#pragma once

#include <string>

#include "sim/model/model_file.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// `radius_m`: the target radius of the image's header. Deterministic. Throws std::invalid_argument that names
// the mesh and the remedy if it has no surface, std::runtime_error that names the package in a build without
// meshoptimizer.
SurfaceSections target_surface(const TriangleMesh& mesh, double radius_m);

// What the sections hold, for a line of output: "2048 points of the surface, 102 mm apart; 1612 triangles,
// 2304 edges, at most 11 mm from the mesh".
std::string description(const SurfaceSections& surface);

}  // namespace tumblesight::sim
