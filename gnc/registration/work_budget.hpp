// WorkBudget: how much work the registration of one frame may take, for any model image and any frame.
//
// Work is counted in instructions, at prices that the LEON3 of docs/audit.md does not exceed: vertices,
// triangles, rows and rays that are drawn, blocks that are compared, edges and places that are followed. It
// is the same for the same inputs on every processor. Each part charges its work and stops when the budget is
// empty. The result of the refinement that was under way is then not used, and the frame is doubtful.
#pragma once

#include <cstdint>

#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {

// Prices in instructions.
namespace work {

// A rendering: once, per vertex, per triangle of the mesh, per one that shows its front, per its rows and
// rays.
inline constexpr std::int32_t kDrawing = 45'000, kVertex = 125, kTriangle = 125, kFront = 495, kRow = 74,
                              kRay = 15;
// A search for dark surfaces: once, per triangle of the mesh, per one that covers a ray, per its rows and
// rays, per one that is the nearest at a ray, per one of them that is judged by its angle of incidence, per
// triangle that is taken out and its rows and rays.
inline constexpr std::int32_t kDarkLook = 50'000, kDarkTriangle = 130, kDarkFront = 360, kDarkRow = 85,
                              kDarkRay = 40, kDarkSeen = 300, kDarkAngle = 400, kTakenOut = 260,
                              kTakenRow = 122, kTakenRay = 20;
// The fit of the ranges: once, per block of rays that is looked at, per one that is compared.
inline constexpr std::int32_t kRanges = 40'000, kBlock = 130, kCompared = 600;
// The fit of the silhouette: once, per edge, per edge that is followed, per place where it crosses a row or
// column, per ray to either side of a place.
inline constexpr std::int32_t kSilhouette = 60'000, kEdge = 87, kSilhouetteEdge = 190, kPlace = 185,
                              kAcross = 85, kEquation = 570;
// A step beside its fits; a table of the silhouette; a refinement, with the evidence at its end.
inline constexpr std::int32_t kStep = 100'000, kTable = 251'000, kRefinement = 270'000;
// A placement besides its rendering, and its search.
inline constexpr std::int32_t kPlacement = 600'000, kSearch = 1'100'000;
// A fit of the motion: per pose, per period or part of it between two poses; per iteration: once, per pose,
// per part of the propagation.
inline constexpr std::int32_t kFitPose = 45'000, kFitPeriod = 195'000, kIteration = 60'000,
                              kIterationPose = 38'000, kIterationPart = 33'000;

}  // namespace work

class WorkBudget {
 public:
  static constexpr std::int32_t kOfAFrame = 91'000'000;

  // Before this call the budget is larger than any frame needs.
  void begin(std::int32_t budget) { left_ = max(budget, 0); }
  // False: not enough is left, and the budget is exhausted from now on. Most work is charged before it is
  // begun. What is charged afterwards exceeds the budget by one triangle or edge at most, 1 M.
  bool spend(std::int32_t work) {
    left_ = work > left_ ? kExhausted : left_ - work;
    return !is_exhausted();
  }
  // What was held back and not taken. An exhausted budget remains so.
  void give_back(std::int32_t work) {
    if (!is_exhausted()) left_ += work;
  }
  bool is_exhausted() const { return left_ == kExhausted; }
  std::int32_t left() const { return max(left_, 0); }

 private:
  static constexpr std::int32_t kExhausted = -1;
  std::int32_t left_ = 0x7FFF'FFFF;
};

}  // namespace tumblesight::gnc
