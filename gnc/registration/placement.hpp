// Placement: where a target of known attitude is in a frame, before it is refined.
//
// The middle of the drawn target is moved to that of the returns. Where a part of the target sends nothing
// back, or something beside it does, that is wrong by rays, and a search over shifts may explain more of the
// returns.
#pragma once

#include "gnc/registration/surface_renderer.hpp"

namespace tumblesight::gnc {

struct PlacementScratch {
  static constexpr int kBlockRays = 4;
  static constexpr int kBlocks = RangeImage::kMaxRays / kBlockRays;       // per side
  using Blocks = std::array<std::array<std::uint8_t, kBlocks>, kBlocks>;  // rays of each block
  Blocks seen, drawn;
};

// `pose`: the attitude, and the origin of the TRF within a radius of its place; the origin is replaced,
// unless the budget is exhausted. `surface` is drawn on.
void place(const SurfaceMesh& mesh, const FrameView& view, RenderedSurface& surface,
           PlacementScratch& scratch, Pose& pose, WorkBudget& budget);

}  // namespace tumblesight::gnc
