// Refinement: moves a pose to where the target's silhouette and surface fit a frame best, by damped
// Gauss-Newton steps.
#pragma once

#include "gnc/registration/dark_surfaces.hpp"
#include "gnc/registration/range_fit.hpp"
#include "gnc/registration/silhouette_fit.hpp"
#include "gnc/registration/surface_renderer.hpp"

namespace tumblesight::gnc {

struct RefinementScratch {
  WorkBudget budget;          // of the frame
  std::int32_t dearest_step;  // work of the dearest step of the frame so far
  RenderedSurface surface;
  DarkSurfaces dark;
  SilhouetteTable table;
  SilhouetteFit silhouette;
  RangeFit ranges;
};

struct RefinementSettings {
  static constexpr int kMaxSteps = 8;
  int steps = 4;                          // limited to 1 ... kMaxSteps
  int thinned_steps = 2;                  // of these, the first that look at half of the rays
  std::int32_t first_sigma_q8 = 256;      // of the silhouette, in 1/256 of a ray; halved by every step ...
  std::int32_t last_sigma_q8 = 40;        // ... down to this one
  std::int32_t turn_sigma_q24 = 838861;   // of the attitude at the start [rad]
  std::int32_t move_sigma_q24 = 8388608;  // of the position at the start [radii]
};

struct Refinement {
  Pose pose;
  NormalEquations equations;  // of the last step, 12 fraction bits
  std::uint32_t fill_q16 = 0;
  // False: the surface was not drawn whole, or the budget was exhausted, and the pose means nothing.
  bool is_complete = true;
};

// `start`: within a few rays of the pose; less than 1 km away. Afterwards `scratch` holds the surface drawn
// at the pose and how its ranges differ (evidence_of()).
void refine(const SurfaceMesh& mesh, const FrameView& view, const Pose& start,
            const RefinementSettings& settings, RefinementScratch& scratch, Refinement& result);

// Goes on from the end of a refinement of the same frame, the last one that used `scratch`. It saves drawing
// the surface there anew.
void refine_further(const SurfaceMesh& mesh, const FrameView& view, const RefinementSettings& settings,
                    RefinementScratch& scratch, Refinement& result);

}  // namespace tumblesight::gnc
