// WorkBudget: how much work the registration of one frame may take, for any model image and any frame.
//
// Work is counted in cycles of LEON3 with the slow multiplier, at prices from the model of docs/audit.md: for
// vertices, triangles, rows and rays that are drawn, blocks that are compared, edges and places that are
// followed. It is the same for the same inputs on every processor.
//
// A frame needs the registration at its first poses. If the budget does not cover it, the frame counts as one
// that could not be registered. All else is begun only if the budget is expected to cover it. A part that
// exceeds the budget after all is not used.
//
// A deadline that passes exhausts the budget, too. Only a caller that gives one makes the registration depend
// on time.
#pragma once

#include <cstdint>

#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {

// Prices in cycles: the least ones that cover 133 frames whose cycles were counted (docs/audit.md), and 3 %
// more.
namespace work {

// A frame: once.
inline constexpr std::int32_t kFrame = 1'750'000;
// A rendering: once, per vertex, per triangle of the mesh, per one that shows its front, per one of them that
// covers a ray, per its rows and rays.
inline constexpr std::int32_t kDrawing = 165'000, kVertex = 186, kTriangle = 129, kFront = 560,
                              kCovering = 290, kRow = 83, kRay = 33;
// A search for dark surfaces: once, per triangle that covers a ray, per its rows and rays, per one that is
// the nearest at a ray, per one of them that is judged by its angle of incidence, per triangle that is taken
// out and its rows and rays.
inline constexpr std::int32_t kDarkLook = 154'000, kDarkTriangle = 990, kDarkRow = 91, kDarkRay = 44,
                              kDarkSeen = 206, kDarkAngle = 1'100, kTakenOut = 268, kTakenRow = 126,
                              kTakenRay = 48;
// The fit of the ranges: once, per block of rays that is looked at, per one that is compared.
inline constexpr std::int32_t kRanges = 22'000, kBlock = 236, kCompared = 1'110;
// The fit of the silhouette: once, per edge, per edge that is followed, per place where it crosses a row or
// column, per ray to either side of a place.
inline constexpr std::int32_t kSilhouette = 114'000, kEdge = 90, kSilhouetteEdge = 249, kPlace = 268,
                              kAcross = 130, kEquation = 1'052;
// A step beside its fits; a table of the silhouette; a refinement, with the evidence at its end.
inline constexpr std::int32_t kStep = 151'000, kTable = 346'000, kRefinement = 455'000;
// A placement besides its rendering, and its search.
inline constexpr std::int32_t kPlacement = 1'065'000, kSearch = 1'390'000;
// A fit of the motion: per pose, per period or part of it between two poses; per iteration: once, per pose,
// per part of the propagation.
inline constexpr std::int32_t kFitPose = 245'000, kFitPeriod = 222'000, kIteration = 575'000,
                              kIterationPose = 48'000, kIterationPart = 38'200;

}  // namespace work

// Until when the registration of a frame may go on.
class Deadline {
 public:
  virtual bool has_passed() = 0;

 protected:
  ~Deadline() = default;
};

class WorkBudget {
 public:
  static constexpr std::int32_t kOfAFrame = 95'000'000;
  // What is charged afterwards exceeds the budget by one triangle or edge at most.
  static constexpr std::int32_t kMostBeyond = 2'000'000;

  // The deadline is asked for at the beginning, and again each time that so much has been spent: about 10 ms
  // on LEON3 at 100 MHz.
  static constexpr std::int32_t kBetweenLooks = 1'000'000;

  // Before this call the budget is larger than any frame needs. `deadline`: must stay valid as long as work
  // is spent, or nullptr.
  void begin(std::int32_t budget, Deadline* deadline = nullptr) {
    left_ = max(budget, 0);
    look_at_ = deadline != nullptr ? left_ : kNever;
    deadline_ = deadline;
    is_late_ = false;
  }
  // False: not enough is left, and the budget is exhausted from now on. Most work is charged before it is
  // begun.
  bool spend(std::int32_t work) {
    left_ = work > left_ ? kExhausted : left_ - work;
    if (left_ <= look_at_) look_at_deadline();
    return !is_exhausted();
  }
  // What was held back and not taken. A budget that is exhausted or late remains so.
  void give_back(std::int32_t work) {
    if (is_exhausted() || is_late_) return;
    left_ += work;
    look_at_ += work;
  }
  bool covers(std::int64_t work) const { return work <= left_; }
  // After a part that the frame can do without, which began with a budget that was not exhausted. If the part
  // exhausted it, nothing is left for others. Returns whether the part was covered.
  bool end_part() {
    const bool was_covered = !is_exhausted();
    if (!was_covered) left_ = 0;
    return was_covered;
  }
  bool is_exhausted() const { return left_ == kExhausted; }
  bool is_late() const { return is_late_; }  // the deadline has passed
  std::int32_t left() const { return max(left_, 0); }

 private:
  void look_at_deadline();

  static constexpr std::int32_t kExhausted = -1, kNever = -0x7000'0000;
  std::int32_t left_ = 0x7FFF'FFFF;
  std::int32_t look_at_ = kNever;  // the deadline is asked for when so much is left, or less
  Deadline* deadline_ = nullptr;
  bool is_late_ = false;
};

}  // namespace tumblesight::gnc
