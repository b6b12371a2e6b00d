// DarkSurfaces: which surfaces of the drawn target send nothing back.
//
// A glossy surface, such as a solar panel, returns light only near its normal. Elsewhere the rays that meet
// it bring nothing back, as those beside the target do. A triangle is dark if few of its own rays return. One
// that covers too few rays is dark if few rays return from all such triangles at its angle of incidence.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/registration/surface_renderer.hpp"

namespace tumblesight::gnc {

// Rays that surfaces cover, without hidden ones.
struct RayCount {
  std::int64_t drawn = 0, returned = 0;
  void add(const RayCount& more) {
    drawn += more.drawn;
    returned += more.returned;
  }
};

struct DarkSurfaces {
  static constexpr int kAngles = 15;  // of incidence: a class every 6 degrees
  std::int32_t surfaces = 0;          // how many are dark; those of one angle of incidence count as one
  // What the last rendering tells of the frame. By this the next one is judged, so that it takes one pass.
  RayCount bright;                           // of the triangles that return as much as all do, or more
  std::array<RayCount, kAngles> of_angle{};  // of those that cover few rays
};

// The first time at a pose: what is bright. `surface`: as render() left it.
void measure_brightness(const SurfaceMesh& mesh, const FrameView& view, const RenderedSurface& surface,
                        DarkSurfaces& dark, WorkBudget& budget);

// `surface`: as render() left it; `dark`: of a pose nearby. Finds what is dark and moves its rays from
// surface.filled to surface.dark; they keep their inverse depth. Sets surface.has_dark. Of a surface that was
// not drawn whole nothing is dark. About the work of a rendering.
void take_out_dark_surfaces(const SurfaceMesh& mesh, const FrameView& view, DarkSurfaces& dark,
                            RenderedSurface& surface, WorkBudget& budget);

}  // namespace tumblesight::gnc
