// Mesh files: a target's surface from a CAD file (STL, OBJ, glTF, GLB), through Assimp.
#pragma once

#include <string>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// Which of the file's axes points up, that is along the TRF's z. glTF is y-up by its standard; STL and OBJ do
// not say, and y is the default for them too, so that one default holds for all files.
enum class MeshUp {
  kY,  // TRF x = file x, y = -file z, z = file y
  kZ,  // the file's axes are the TRF's
};

struct MeshFileOptions {
  MeshUp up = MeshUp::kY;
  double scale = 1.0;  // metres to a unit of the file
};

// A mesh must fit the sensor at the scenarios' shortest range (20 m, field of view at most 40 degrees: a
// swath of 14.5 m, less a margin), and a target smaller than a hand is a wrong unit.
inline constexpr double kMaxMeshRadius_m = 6.9;
inline constexpr double kMinMeshRadius_m = 0.1;

// The file's triangles in the TRF, metres, with its node transforms applied and equal vertices joined; the
// file is trusted to have its origin where the TRF's origin shall be. Nothing is repaired or removed but what
// Assimp leaves out on reading (points, lines, glTF faces with an index out of range): a file with a fault is
// refused. Throws std::runtime_error that names the file, what is wrong with it, the value and the limit, and
// what to do, for: scale not positive or not finite; file missing, unreadable, or not named .stl, .obj, .gltf
// or .glb and of that format; no triangles; vertices that are not finite; triangles without area; a radius
// outside kMinMeshRadius_m..kMaxMeshRadius_m.
TriangleMesh load_mesh_file(const std::string& path, const MeshFileOptions& options = {});

// "y" or "z"; throws std::invalid_argument otherwise.
MeshUp mesh_up_from(const std::string& name);

}  // namespace tumblesight::sim
