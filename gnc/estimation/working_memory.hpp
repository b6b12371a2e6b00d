// WorkingMemory: what the stages of a frame need for themselves only, one after the other in the same bytes.
// A stage writes all that it reads, so that what another one left there is never used.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "gnc/lidar/depth_image.hpp"
#include "gnc/rcnn/network.hpp"
#include "gnc/registration/inlier_ratios.hpp"
#include "gnc/registration/pose_tracker.hpp"

namespace tumblesight::gnc {

template <class N>
class WorkingMemory {
 public:
  // In the order of the stages.
  DepthImageScratch& projection() { return in_place<DepthImageScratch>(bytes_); }
  Activations<N>& activations() { return in_place<Activations<N>>(bytes_); }
  InlierRatiosScratch& inlier_ratios() { return in_place<InlierRatiosScratch>(bytes_); }
  PoseScratch& pose() { return in_place<PoseScratch>(bytes_); }

 private:
  static constexpr std::size_t kBytes = std::max(
      {sizeof(DepthImageScratch), sizeof(Activations<N>), sizeof(InlierRatiosScratch), sizeof(PoseScratch)});
  alignas(64) std::array<std::byte, kBytes> bytes_;
};

}  // namespace tumblesight::gnc
