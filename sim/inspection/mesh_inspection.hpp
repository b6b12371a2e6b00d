// MeshInspection: the properties of a user's mesh, and the findings that would harm the training of a
// network.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sim/inspection/hiding_part.hpp"
#include "sim/inspection/likely_unit.hpp"
#include "sim/inspection/marker_cube.hpp"
#include "sim/inspection/mesh_edges.hpp"
#include "sim/inspection/mesh_symmetry.hpp"
#include "sim/inspection/separate_parts.hpp"
#include "sim/world/target/mesh_file.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

enum class Severity {
  kFault,    // the mesh is refused, or no network can tell its attitude
  kWarning,  // a likely mistake, or accuracy is lost
  kNote,     // of no consequence for the sensor model
};

struct Finding {
  std::string key;  // "size", "unit", "up", "origin", "strays", "symmetry", ...: one word, for files
  Severity severity = Severity::kNote;
  std::string text;    // what was found, with its figures
  std::string remedy;  // what to do; empty for a note without one
};

// How far the surface is the same after any turn about an axis.
enum class Roundness { kNone, kAboutAnAxis, kSphere };

// Lengths in metres after --mesh-scale, places and axes in the TRF.
struct MeshInspection {
  std::size_t triangles = 0;
  std::size_t left_out = 0;  // without area
  std::size_t repeated = 0;  // with the corners of an earlier one
  std::size_t shells = 0;    // sets of triangles that share corners
  MeshEdges edges;
  double area_m2 = 0.0;
  Eigen::AlignedBox3d box_trf_m;
  double radius_m = 0.0;       // about the origin, of everything
  double core_radius_m = 0.0;  // about the origin, without strays
  // About the centre of the surface, that of the box or the origin, whichever is least; without strays.
  double centred_radius_m = 0.0;
  double radius_of_95_m = 0.0;  // about the centre of the surface: 95 % of the outer surface lie within
  std::vector<SeparatePart> parts;
  std::vector<std::size_t> strays;  // numbers of parts
  std::optional<MarkerCube> marker;
  std::optional<HidingPart> hiding;
  SurfaceSymmetry symmetry;  // of the outer surface, without strays
  Roundness roundness = Roundness::kNone;
  Eigen::Vector3d round_axis_trf = Eigen::Vector3d::UnitZ();
  std::size_t panels = 0;
  bool panels_are_named = false;   // by their material
  std::vector<Unit> likely_units;  // of the file, the likeliest first
  std::vector<Finding> findings;   // the gravest first

  double centre_distance_m() const { return symmetry.centre_trf_m.norm(); }
  // Whether the marker cube is surely not of the spacecraft, or no loss: it hides most of the rest, or nearly
  // nothing of the outer surface is lost without it. Any other may be the body.
  bool marker_can_go() const;
};

// A mesh of any size, as read_mesh_file() gives it. Deterministic; takes a few seconds. Throws
// std::runtime_error if Embree refuses the mesh.
MeshInspection inspect(const TriangleMesh& mesh, const MeshFileOptions& options);

// A mean distance below this share of the radius counts as none: no frame can tell the attitudes apart.
inline constexpr double kSameSurface = 0.001;
// Below this share a network has to tell the attitudes apart by small parts alone.
inline constexpr double kNearlySameSurface = 0.02;

// Below this share of the outer surface a marker cube is no loss.
inline constexpr double kNoLoss = 0.01;

// The fold after which the surface is most nearly the same about this axis: its number in kFolds.
std::size_t best_fold(const SymmetryAxis& axis);

}  // namespace tumblesight::sim
