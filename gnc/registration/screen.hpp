// The screen of a frame, which surfaces are drawn on: columns to the right and rows downward, in 1/64 of a
// ray; the middle of ray k is at 64 k + 32.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/surface/surface_mesh.hpp"

namespace tumblesight::gnc {

inline constexpr int kScreenBits = 6;
inline constexpr int kScreenRay = 1 << kScreenBits;

// First ray whose middle is at `coordinate` or after it, and last one at it or before it.
inline int first_ray(std::int32_t coordinate) {
  return (coordinate + kScreenRay / 2 - 1) >> kScreenBits;
}
inline int last_ray(std::int32_t coordinate) {
  return (coordinate - kScreenRay / 2) >> kScreenBits;
}

// A vertex on the screen.
struct ScreenPoint {
  std::int16_t column, row;    // in 1/64 of a ray
  std::int16_t inverse_depth;  // of the FrameView
  bool is_outside() const { return column == kOutside; }
  static constexpr std::int16_t kOutside = -32768;
};

using ScreenVertices = std::array<ScreenPoint, SurfaceMesh::kMaxVertices>;

// Twice the area of the triangle (a, b, p), positive if p is on the right of the way from a to b on a screen
// whose rows run downward.
inline std::int32_t area(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& p) {
  return (b.column - a.column) * (p.row - a.row) - (b.row - a.row) * (p.column - a.column);
}

}  // namespace tumblesight::gnc
