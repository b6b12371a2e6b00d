#include "sim/surface/target_surface.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "sim/surface/surface_mesh.hpp"
#include "sim/surface/surface_samples.hpp"

namespace tumblesight::sim {

SurfaceSections target_surface(const TriangleMesh& mesh, double radius_m) {
  try {
    return {surface_section(mesh, radius_m), surface_mesh_section(mesh, radius_m)};
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format(
        "the surface of mesh {} cannot be put into a model image: {}; give a mesh of the target's outer "
        "surface, in metres (--mesh, --mesh-scale)",
        mesh.name, error.what()));
  }
}

std::string description(const SurfaceSections& surface) {
  const gnc::SurfaceModel points(surface.points.data());
  const gnc::SurfaceMesh mesh(surface.mesh.data());
  return fmt::format(
      "{} points of the surface, {} mm apart; {} triangles, {} edges, at most {} mm from the mesh",
      points.points(), points.spacing_mm(), mesh.triangles(), mesh.edges(), mesh.error_mm());
}

}  // namespace tumblesight::sim
