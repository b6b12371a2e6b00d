// The six sides of a mesh, each seen along an axis of the TRF from far away.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// What a view shows: axes of the TRF with their signs, for instance "+x".
struct ViewSide {
  const char* from;   // where the viewer stands
  const char* right;  // in the picture
  const char* up;
};
inline constexpr std::array<ViewSide, 6> kViewSides{{{"+x", "+y", "+z"},
                                                     {"+y", "-x", "+z"},
                                                     {"+z", "+x", "+y"},
                                                     {"-x", "-y", "+z"},
                                                     {"-y", "+x", "+z"},
                                                     {"-z", "-x", "+y"}}};

struct SideView {
  ViewSide side;
  int pixels = 0;  // per side; the picture is as wide as the mesh's diameter about its middle
  // The TRF's origin, or the centre of a mesh that is far from it: about the origin nothing would be seen.
  Eigen::Vector3d middle_trf_m = Eigen::Vector3d::Zero();
  double swath_m = 0.0;           // width of the picture
  std::vector<float> brightness;  // 0..1, from the top left; 0: nothing is there. Lit from the viewer
  std::vector<float> nearness;    // 0 at the far end of the mesh's ball, 1 at its near end
};

std::array<SideView, 6> six_views(const TriangleMesh& mesh, int pixels);

}  // namespace tumblesight::sim
