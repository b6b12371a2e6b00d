// RangeFit: how the target has to move so that its surface lies where the returns are.
//
// The differences of measured and rendered inverse depth are averaged over blocks of 2 x 2 rays on one plane.
// The plane's slope on the screen says how a motion of the target changes them. Large differences, in
// standard deviations of one ray, count less (Geman and McClure).
#pragma once

#include <cstdint>

#include "gnc/registration/normal_equations.hpp"
#include "gnc/registration/surface_renderer.hpp"

namespace tumblesight::gnc {

struct RangeFit {
  NormalEquations equations;    // rows in 1/256 standard deviation of a ray
  std::int64_t squares_q8 = 0;  // squared differences over the variance, each limited to 9
  std::int32_t blocks = 0;      // that were compared
};

// every: 2 compares every second block of a row and counts each twice in the equations: half the work, for
// steps that later ones correct.
void fit_ranges(const FrameView& view, const Pose& pose, const RenderedSurface& surface, RangeFit& fit,
                WorkBudget& budget, int every = 1);

// Share of the rays well inside the target that return, Q16; 1 without such rays.
std::uint32_t fill_share(const FrameView& view, const RenderedSurface& surface);

}  // namespace tumblesight::gnc
