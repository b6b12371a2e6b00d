// A part of a mesh that is not of the spacecraft and hides it: an exporter's marker cube, a sky dome, a
// ground plane. A sensor would see this part in place of the spacecraft.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "sim/inspection/marker_cube.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

struct HidingPart {
  std::vector<std::size_t> triangles;
  double width_m = 0.0;    // its longest side
  double hidden = 0.0;     // share of the area of all other parts that is inside it; 0 for a plane
  double rest_m2 = 0.0;    // area of all other parts
  bool is_marker = false;  // it is the marker cube
  bool is_plane = false;   // flat, wider than all the rest, which stands on one side of it
};

// A cube that marks the origin hides if more of the rest is inside; so does a cover of another shape. The
// hull of a body hides what is inside, too, but the antennas and panels outside are most of the rest.
inline constexpr double kHiddenByMarker = 0.05;
inline constexpr double kHiddenByCover = 0.5;

// The parts whose boxes meet enough of the area of the others for them to be a cover, the largest box first;
// the first of them is the marker, if it is one. The parts are numbered as connected_parts() gives them. At
// most kMostCovers: a mesh of many thousand bolts has a handful. The tests that follow take long.
inline constexpr std::size_t kMostCovers = 32;
std::vector<std::size_t> possible_covers(const TriangleMesh& mesh,
                                         const std::vector<std::vector<std::size_t>>& parts,
                                         const std::optional<MarkerCube>& marker);

// Of closed convex parts that hide more than that, the one that hides most; otherwise a plane. Empty if there
// is none. Only parts that are seen from outside count.
std::optional<HidingPart> hiding_part(const TriangleMesh& mesh, const std::optional<MarkerCube>& marker);

}  // namespace tumblesight::sim
