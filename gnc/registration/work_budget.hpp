// WorkBudget: how much work the registration of one frame may take, whatever image and frame ask for.
//
// Work is counted in instructions, at prices that the LEON3 of docs/audit.md does not exceed: vertices,
// triangles, rows and rays that are drawn, blocks that are compared, edges and places that are followed. It
// is the same for the same inputs on every processor. What is done is taken from the budget; when nothing is
// left, each part ends at once. The refinement that was under way means nothing then, and the frame is
// doubtful.
#pragma once

#include <cstdint>

namespace tumblesight::gnc {

// Prices in instructions.
namespace work {

// A rendering: once, per vertex, per triangle of the mesh, per one that shows its front, per its rows and
// rays.
inline constexpr std::int32_t kDrawing = 16'000, kVertex = 125, kTriangle = 125, kFront = 495, kRow = 74,
                              kRay = 15;
// A look at what is dark, likewise, and per row and ray of a triangle that is taken out.
inline constexpr std::int32_t kDarkLook = 10'000, kDarkTriangle = 107, kDarkFront = 600, kDarkRow = 82,
                              kDarkRay = 36, kTakenRow = 122, kTakenRay = 20;
// The fit of the ranges: once, per block of rays that is looked at, per one that is compared.
inline constexpr std::int32_t kRanges = 40'000, kBlock = 130, kCompared = 600;
// The fit of the outline: once, per edge, per edge that is followed, per place where it crosses a row or
// column, per ray to either side of a place.
inline constexpr std::int32_t kOutline = 60'000, kEdge = 87, kOutlineEdge = 190, kPlace = 120, kAcross = 85,
                              kEquation = 570;
// What a step takes besides, and a table of the outline; a refinement, with the evidence at its end.
inline constexpr std::int32_t kStep = 100'000, kTable = 251'000, kRefinement = 270'000;
// A placement besides its rendering, and its search.
inline constexpr std::int32_t kPlacement = 600'000, kSearch = 1'100'000;

}  // namespace work

class WorkBudget {
 public:
  static constexpr std::int32_t kOfAFrame = 80'000'000;
  // The largest single charge: vertices and triangles of the largest mesh. Most charges come before the work,
  // which is then not begun.
  static constexpr std::int32_t kMostBeyond = 1'200'000;

  // Until it begins, there is no limit that a frame could reach.
  void begin(std::int32_t budget = kOfAFrame) { left_ = budget; }
  // False: nothing is left.
  bool spend(std::int32_t work) {
    if (left_ >= 0) left_ -= work;
    return left_ >= 0;
  }
  bool is_exhausted() const { return left_ < 0; }
  std::int32_t left() const { return left_; }  // negative: exhausted

 private:
  std::int32_t left_ = 0x7FFF'FFFF;
};

}  // namespace tumblesight::gnc
