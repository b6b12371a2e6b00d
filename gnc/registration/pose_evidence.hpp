// PoseEvidence: counts of the rays of a frame that agree with a pose and that contradict it. It compares
// alternatives and verifies the pose that is reported. Specification: docs/numerics.md.
#pragma once

#include <cstdint>

#include "gnc/registration/range_fit.hpp"
#include "gnc/registration/surface_renderer.hpp"

namespace tumblesight::gnc {

// Counts of rays, except those that something hides. "At the silhouette": next to a drawn and to an empty
// ray.
struct PoseEvidence {
  std::int32_t drawn = 0;            // meet the target at the pose, away from its silhouette
  std::int32_t missing = 0;          // of them: without a return
  std::int32_t returned = 0;         // returns of the target
  std::int32_t unexplained = 0;      // of them: neither drawn nor at the silhouette
  std::int32_t silhouette = 0;       // at the silhouette, and not as drawn
  std::int32_t silhouette_rays = 0;  // at the silhouette
  std::int32_t dark = 0;             // meet a dark surface; neither drawn nor missing
  std::int32_t dark_returned = 0;    // of them: with a return, and not at the silhouette
  std::int32_t dark_surfaces = 0;    // dark surfaces
  std::int32_t blocks = 0;           // whose mean range was compared
  std::int64_t squares_q8 = 0;  // sum over the blocks of the squared differences, each at most 9 [sigma^2]

  // About 1 at the right pose, at most 9; 0 without a block.
  std::int32_t mean_square_q8() const;
  std::uint32_t unexplained_ppm() const;  // of the returns
  std::uint32_t missing_ppm() const;      // (missing + dark) / (drawn + dark)
  // Negative logarithm of the likelihood, up to a constant of the frame [nats].
  std::int32_t cost_q8() const;

  // At most 1.6 sigma^2 in the mean, of one block or more.
  bool fits_ranges() const;
  // At most 3 % of the returns are beside the target, and at most 69 % of its rays are missing or dark.
  bool fits_returns() const;
  // The silhouette is where the frame shows one, within `halves` / 2 of the limit: at most an eighth of the
  // rays at it are not as drawn. As many returns as elsewhere may be missing: of the half of these rays that
  // are drawn.
  bool fits_silhouette(int halves = 2) const;
  // All of them: the pose explains the frame.
  bool fits() const { return fits_silhouette() && fits_ranges() && fits_returns(); }
};

// `ranges`: fit_ranges() of `surface`; `dark_surfaces`: how many of it are dark, if any.
PoseEvidence evidence_of(const FrameView& view, const RenderedSurface& surface, const RangeFit& ranges,
                         std::int32_t dark_surfaces);

}  // namespace tumblesight::gnc
