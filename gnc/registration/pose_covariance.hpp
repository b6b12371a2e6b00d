// PoseCovariance: how well a fitted motion is known, as standard deviations and correlations.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/registration/pose_fit.hpp"

namespace tumblesight::gnc {

// Order of the twelve unknowns: turn about the x, y and z axis of the LRF, rate, position of the TRF's
// origin, velocity.
struct PoseCovariance {
  // [urad, urad/s, um, um/s], three each.
  std::array<std::uint32_t, kMotionUnknowns> sigma{};
  // Below the diagonal, row by row: (1, 0), (2, 0), (2, 1), (3, 0), ... Q15.
  std::array<std::int16_t, kMotionElements - kMotionUnknowns> correlation_q15{};
};

// The inverse of the information, scaled by how well the poses agree, and a part that does not shrink with
// more frames: the mesh is not exact, and neighbouring frames share its errors. `poses`: 1 ... 10, that
// `fit` is fitted to.
void make_covariance(const PoseFitResult& fit, int poses, std::int32_t target_radius_um,
                     PoseCovariance& covariance);

}  // namespace tumblesight::gnc
