// SilhouetteFit: how the target has to move so that its silhouette lies between the rays that return and
// those that do not.
//
// Along the rendered silhouette, at every ray, the rays across it are looked at. A ray at the distance d
// outside the silhouette returns with the probability fill / (1 + exp(d / sigma)): fill is the share of the
// returns that the sensor delivers, sigma says how far off the silhouette may be. Each ray adds the
// derivative of the logarithm of the probability of what it did, and its Fisher information (as region-based
// tracking does; Stoiber et al., ACCV 2020).
#pragma once

#include <array>
#include <cstdint>

#include "gnc/registration/normal_equations.hpp"
#include "gnc/registration/surface_renderer.hpp"

namespace tumblesight::gnc {

// By the distance from the silhouette, in steps of an eighth of sigma from -6 sigma on. Q12.
struct SilhouetteTable {
  static constexpr int kPerSigma = 8;
  static constexpr int kSteps = 2 * 6 * kPerSigma + 1;
  // Derivative by a silhouette that moves out [1 / sigma].
  std::array<std::int16_t, kSteps> if_hit, if_missed;
  std::array<std::int16_t, kSteps> information;  // [1 / sigma^2]
};
// fill_q16: share of the rays on the target that return, limited to 1/2 to 99 %.
void make_silhouette_table(std::uint32_t fill_q16, SilhouetteTable& table);

struct SilhouetteFit {
  // Rows are in 1/16384 of a ray per ray of silhouette; to be multiplied by (rays per radius / sigma)^2 and,
  // the gradient, by rays per radius / sigma.
  NormalEquations equations;
  std::int64_t length_q8 = 0;  // of the silhouette that was looked at [rays]
};

// sigma_q8: in 1/256 of a ray, at least 16. every: 1, or 2 to look at every second row and column only and
// count each twice: half the work, for steps that later ones correct. When the budget is exhausted, no more
// edge is followed.
void fit_silhouette(const SurfaceMesh& mesh, const FrameView& view, const Pose& pose,
                    const RenderedSurface& surface, const SilhouetteTable& table, std::int32_t sigma_q8,
                    SilhouetteFit& fit, WorkBudget& budget, int every = 1);

}  // namespace tumblesight::gnc
