// Mesh files: a target's surface from a CAD file or a scan (STL, OBJ, PLY, glTF, GLB).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// The axis of the file that points up, that is along the TRF's z. glTF is y-up by its standard. STL and OBJ
// do not define it; y is the default for them too, so that one default holds for all files.
enum class MeshUp {
  kY,  // TRF x = file x, y = -file z, z = file y
  kZ,  // the file's axes are the TRF's
};

struct MeshFileOptions {
  MeshUp up = MeshUp::kY;
  double scale = 1.0;                                      // metres per unit of the file, positive
  Eigen::Vector3d origin_trf_m = Eigen::Vector3d::Zero();  // the place that becomes the origin
};

// A target of this radius is 40 m across and fits into a field of view of 40 degrees from 58 m. A larger one,
// or one smaller than a hand, indicates a wrong unit.
inline constexpr double kMaxMeshRadius_m = 20.0;
inline constexpr double kMinMeshRadius_m = 0.1;

// Triangles without area are left out, since no ray hits them. A file in which more of them have none is
// damaged.
inline constexpr double kMaxShareWithoutArea = 0.2;
inline constexpr std::size_t kMaxTriangles = 5'000'000;

// The triangles of the file in the TRF, in metres, with node transforms applied, equal vertices joined and
// meshes decompressed (Draco). The origin of the file becomes the origin of the TRF, unless `origin_trf_m`
// moves it. Left out are triangles without area, which TriangleMesh::left_out counts, points and lines.
// Polygons are divided into triangles. Nothing else is repaired. TriangleMesh::notes and losses say what else
// was left out.
//
// Throws std::runtime_error that names the file, the fault, the value, the limit and the remedy for: a scale
// that is not positive and finite; a file that is missing, unreadable, or not of the format that its
// extension .stl, .obj, .ply, .gltf or .glb names, or cut off; a compression that this build cannot read; no
// triangles, or more than kMaxTriangles; vertices that are not finite; too much surface without area or
// crossed.
TriangleMesh read_mesh_file(const std::string& path, const MeshFileOptions& options = {});

// Empty if the sensor can see a target of this size; otherwise the size, the limit and the remedies.
std::string fault_of_size(const TriangleMesh& mesh, double scale);

// read_mesh_file(), which also throws for a radius outside kMinMeshRadius_m..kMaxMeshRadius_m.
TriangleMesh load_mesh_file(const std::string& path, const MeshFileOptions& options = {});

// "6 of 9312 triangles (0.06 %) have no area and are left out: no ray hits them". Empty if none was left out.
std::string left_out_note(const TriangleMesh& mesh);

// What else of the file was left out (TriangleMesh::notes), in one line. Empty if nothing was.
std::string reading_note(const TriangleMesh& mesh);

// The files that belong to a mesh file: an OBJ's materials, a glTF's buffers and images
// (mesh_side_files.cpp). They need not exist. Empty for other formats, and for a file that is missing or
// damaged.
std::vector<std::string> mesh_side_files(const std::string& path);

// "my%20mesh.bin" -> "my mesh.bin", as glTF names files.
std::string decoded_uri(const std::string& uri);

// "y" or "z"; throws std::invalid_argument otherwise.
MeshUp mesh_up_from(const std::string& name);

// Checks of the structure of glTF 2.0 files (gltf_check.cpp): of a GLB file's parts, of the JSON's depth, of
// extensions, types and numbers, and of the tree of nodes. They throw std::runtime_error that says what is
// wrong, without the name of the file. gltf_surface() checks the data.
void check_gltf(const std::string& path);
void check_glb(const std::string& path);

}  // namespace tumblesight::sim
