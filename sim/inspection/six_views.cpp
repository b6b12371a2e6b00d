#include "sim/inspection/six_views.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>

#include "sim/surface/outside_views.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kFar = 20.0;      // radii of the mesh about its own centre
constexpr float kDarkest = 0.25F;  // of a surface that is seen edge-on

// "-x" -> (-1, 0, 0)
Eigen::Vector3d direction(const char* name) {
  return (name[0] == '-' ? -1.0 : 1.0) * Eigen::Vector3d::Unit(name[1] - 'x');
}

FrameTruth truth_of(const ViewSide& side, double radius_m) {
  Eigen::Matrix3d r_lrf_trf;
  r_lrf_trf.row(0) = direction(side.right);
  r_lrf_trf.row(1) = -direction(side.from);
  r_lrf_trf.row(2) = direction(side.up);
  return {Eigen::Quaterniond(r_lrf_trf), Eigen::Vector3d::Zero(), kOutsideDistance_radii * radius_m};
}

Eigen::Vector3d middle_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : mesh.vertices_trf_m) box.extend(vertex.cast<double>());
  const bool is_far = mesh.radius_m() > kFar * 0.5 * box.diagonal().norm();
  if (!is_far) return Eigen::Vector3d::Zero();
  return box.center();
}

TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3d& by) {
  for (Eigen::Vector3f& vertex : mesh.vertices_trf_m) vertex = (vertex.cast<double>() + by).cast<float>();
  return mesh;
}

}  // namespace

std::array<SideView, 6> six_views(const TriangleMesh& whole, int pixels) {
  const Eigen::Vector3d middle_trf_m = middle_of(whole);
  const TriangleMesh mesh = moved(whole, -middle_trf_m);
  const FlashLidar lidar(mesh);
  const double radius_m = mesh.radius_m();
  std::array<SideView, 6> views;
  for (std::size_t i = 0; i < views.size(); ++i) {
    SideView& view = views[i];
    view.side = kViewSides[i];
    view.pixels = pixels;
    view.middle_trf_m = middle_trf_m;
    view.swath_m = swath_m(mesh);
    const FrameTruth truth = truth_of(view.side, radius_m);
    const RangeGrid grid = lidar.true_surfaces(truth, pixels, view.swath_m);
    for (std::size_t ray = 0; ray < grid.range_m.size(); ++ray) {
      const bool hit = std::isfinite(grid.range_m[ray]);
      const auto facing = static_cast<float>(grid.surfaces[ray].cos_incidence);
      const auto near = static_cast<float>((truth.range_m + radius_m - grid.range_m[ray]) / (2.0 * radius_m));
      view.brightness.push_back(hit ? kDarkest + (1.0F - kDarkest) * facing : 0.0F);
      view.nearness.push_back(hit ? near : 0.0F);
    }
  }
  return views;
}

}  // namespace tumblesight::sim
