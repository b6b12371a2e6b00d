// PoseEvidence: what speaks against a pose, by the rays of a frame. It compares alternatives and verifies the
// pose that is reported. Specification: docs/numerics.md.
#pragma once

#include <cstdint>

#include "gnc/registration/range_fit.hpp"
#include "gnc/registration/surface_renderer.hpp"

namespace tumblesight::gnc {

// Counts of rays, except those that something hides. "At the outline": next to a drawn and to an empty ray.
struct PoseEvidence {
  std::int32_t drawn = 0;        // meet the target at the pose, away from its outline
  std::int32_t missing = 0;      // of them: without a return
  std::int32_t returned = 0;     // returns of the target
  std::int32_t unexplained = 0;  // of them: neither drawn nor at the outline
  std::int32_t outline = 0;      // at the outline, and not as drawn
  std::int32_t blocks = 0;       // whose mean range was compared
  std::int64_t squares_q8 = 0;   // sum over the blocks of the squared differences, each at most 9 [sigma^2]

  // About 1 at the right pose, at most 9; 0 without a block.
  std::int32_t mean_square_q8() const;
  std::uint32_t unexplained_ppm() const;  // of the returns
  std::uint32_t missing_ppm() const;      // of the drawn rays
  // Negative logarithm of the likelihood, up to a constant of the frame [nats].
  std::int32_t cost_q8() const;
};

// `ranges`: fit_ranges() of `surface`.
PoseEvidence evidence_of(const FrameView& view, const RenderedSurface& surface, const RangeFit& ranges);

}  // namespace tumblesight::gnc
