// The rays of the screen that a triangle covers, row by row, with the inverse depth of its plane.
#pragma once

#include <cstdint>

#include "gnc/numerics/functions.hpp"
#include "gnc/numerics/select.hpp"
#include "gnc/registration/reciprocal.hpp"
#include "gnc/registration/screen.hpp"

namespace tumblesight::gnc {

struct Bounds {
  int first, last;
  bool is_empty() const { return first > last; }
};
inline Bounds bounds(std::int32_t a, std::int32_t b, std::int32_t c, int rays) {
  return {max_small(0, first_ray(min_small(a, min_small(b, c)))),
          min_small(rays - 1, last_ray(max_small(a, max_small(b, c))))};
}

// Where an edge crosses the middles of the rows, with kBits fraction bits.
class Crossing {
 public:
  static constexpr int kBits = 14;
  static constexpr std::int32_t kOne = 1 << kBits;

  // `a` above `b`; `row`: the first one.
  Crossing(const ScreenPoint& a, const ScreenPoint& b, int row) {
    const std::int32_t down = b.row - a.row;
    const std::int32_t slope = down == 0 ? 0 : ((b.column - a.column) * kOne) / down;  // per 1/64 of a ray
    column_ = a.column * kOne + slope * (row * kScreenRay + kScreenRay / 2 - a.row);
    // An edge that is less high crosses one row at most.
    per_row_ = down < kScreenRay ? 0 : slope * kScreenRay;
  }
  std::int32_t column() const { return column_; }
  void next_row() { column_ += per_row_; }

 private:
  std::int32_t column_, per_row_;
};

// The inverse depth of a triangle's plane, in 1/256.
struct Plane {
  std::int32_t at_first;  // at the middle of the first ray of `rows` and `columns`
  std::int32_t per_column, per_row;
  std::int32_t lowest, highest;  // of the corners, in whole numbers
};
inline Plane plane_of(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c, std::int32_t whole,
                      const Bounds& rows, const Bounds& columns) {
  const std::int32_t to_b = b.inverse_depth - a.inverse_depth, to_c = c.inverse_depth - a.inverse_depth;
  // 1 / whole, by a reciprocal of the number with 30 bits.
  const int shift = 29 - highest_bit_32(static_cast<std::uint32_t>(whole));
  const std::int32_t inverse_q28 = reciprocal_q28(whole * (1 << shift));
  // * 64 * 256 / whole; the halves keep the difference within 32 bits.
  const auto per_ray = [&](std::int32_t first, std::int32_t second) -> std::int32_t {
    constexpr std::int32_t kLargest = 1 << 22;
    const std::int32_t half = (first >> 1) - (second >> 1);
    if ((half >> 7) >= whole) return kLargest;
    if ((half >> 7) < -whole) return -kLargest;
    const std::int32_t scaled = shift >= 7 ? half * (1 << (shift - 7)) : half >> (7 - shift);
    return high_product(scaled, inverse_q28) >> 4;
  };
  Plane plane{};
  plane.per_column = per_ray(to_b * (c.row - a.row), to_c * (b.row - a.row));
  plane.per_row = per_ray(to_c * (b.column - a.column), to_b * (c.column - a.column));
  const std::int32_t right = columns.first * kScreenRay + kScreenRay / 2 - a.column;
  const std::int32_t down = rows.first * kScreenRay + kScreenRay / 2 - a.row;
  // (per_column right + per_row down) / 64, in parts that fit into 32 bits: right and down are below 2^14.
  constexpr std::int32_t kMost = 1 << 29, kLowBits = kScreenRay - 1;
  const std::int32_t low = (plane.per_column & kLowBits) * right + (plane.per_row & kLowBits) * down;
  const std::int32_t from_a = (plane.per_column >> kScreenBits) * right +
                              (plane.per_row >> kScreenBits) * down + (low >> kScreenBits);
  plane.at_first = a.inverse_depth * 256 + 128 + min_small(max_small(from_a, -kMost), kMost);
  plane.lowest = min_small(a.inverse_depth, min_small(b.inverse_depth, c.inverse_depth));
  plane.highest = max_small(a.inverse_depth, max_small(b.inverse_depth, c.inverse_depth));
  return plane;
}

// A triangle of the mesh that shows its front: area(a, b, c) = whole > 0, and the rows and columns of rays
// that it may cover.
struct ScreenTriangle {
  int index;
  const ScreenPoint &a, &b, &c;
  std::int32_t whole;
  Bounds rows, columns;

  int height() const { return rows.last - rows.first + 1; }
};

// Calls visit(row, first column, last column, inverse depth at the first in 1/256, plane) for every row of a
// triangle in which it covers a ray. Returns the number of rays.
template <class Visit>
inline int visit_spans(const ScreenTriangle& triangle, Visit&& visit) {
  const auto& [index, a, b, c, whole, rows, columns] = triangle;
  // The corners from top to bottom. The long edge joins the first and the last one.
  const ScreenPoint *top = &a, *middle = &b, *bottom = &c;
  bool is_long_edge_left = false;
  const auto exchange = [&](const ScreenPoint*& p, const ScreenPoint*& q) {
    const ScreenPoint* const kept = p;
    p = q;
    q = kept;
    is_long_edge_left = !is_long_edge_left;
  };
  if (top->row > middle->row) exchange(top, middle);
  if (middle->row > bottom->row) exchange(middle, bottom);
  if (top->row > middle->row) exchange(top, middle);
  // To the right of the way down a triangle with positive area has its corners in turn.
  is_long_edge_left = !is_long_edge_left;

  Crossing long_edge(*top, *bottom, rows.first);
  // Rows with their middle above the middle corner or, unless the upper edge is level, at it.
  const int bend = top->row == middle->row
                       ? rows.first
                       : max_small(rows.first, min_small(rows.last, last_ray(middle->row)) + 1);
  Plane plane{};
  int covered = 0;
  // Above the bend, then below it.
  for (int part = 0, row = rows.first; part < 2; ++part) {
    const int end = part == 0 ? bend : rows.last + 1;
    if (row >= end) continue;
    Crossing short_edge(part == 0 ? *top : *middle, part == 0 ? *middle : *bottom, row);
    for (; row < end; ++row) {
      const std::int32_t left = is_long_edge_left ? long_edge.column() : short_edge.column();
      const std::int32_t right = is_long_edge_left ? short_edge.column() : long_edge.column();
      long_edge.next_row();
      short_edge.next_row();
      constexpr std::int32_t kHalf = Crossing::kOne * kScreenRay / 2;
      const int first = max_small(columns.first, (left + kHalf - 1) >> (Crossing::kBits + kScreenBits));
      const int last = min_small(columns.last, (right - kHalf) >> (Crossing::kBits + kScreenBits));
      if (first > last) continue;
      // Many triangles lie between the rays and need no plane.
      if (covered == 0) plane = plane_of(a, b, c, whole, rows, columns);
      const std::int32_t inverse_depth =
          plane.at_first + plane.per_row * (row - rows.first) + plane.per_column * (first - columns.first);
      visit(row, first, last, inverse_depth, plane);
      covered += last - first + 1;
    }
  }
  return covered;
}

// Calls visit(triangle) if triangle `index` of the drawn surface's mesh shows its front and may cover a ray.
// kOutside: it has a corner that is not on the screen, which is not looked for if `all_inside`. kStop:
// `visit` gave false.
enum class Visited { kGoOn, kOutside, kStop };
template <class Visit>
inline Visited visit_front(const SurfaceMesh& mesh, int index, int rays, const ScreenVertices& vertices,
                           bool all_inside, Visit&& visit) {
  const SurfaceMesh::Triangle triangle = mesh.triangle(index);
  // The image was sound when it was loaded, but its memory may have been damaged since.
  if (!mesh.has(triangle[0], triangle[1], triangle[2])) return Visited::kGoOn;
  const auto vertex = [&](std::size_t corner) -> const ScreenPoint& {
    return vertices[static_cast<std::size_t>(triangle[corner])];
  };
  const ScreenPoint &a = vertex(0), &b = vertex(1), &c = vertex(2);
  if (!all_inside && (a.is_outside() || b.is_outside() || c.is_outside())) return Visited::kOutside;
  // Its corners run counterclockwise if it shows its front.
  const std::int32_t whole = area(a, c, b);
  if (whole <= 0) return Visited::kGoOn;
  const Bounds rows = bounds(a.row, b.row, c.row, rays);
  if (rows.is_empty()) return Visited::kGoOn;
  const Bounds columns = bounds(a.column, b.column, c.column, rays);
  if (columns.is_empty()) return Visited::kGoOn;
  return visit(ScreenTriangle{index, a, c, b, whole, rows, columns}) ? Visited::kGoOn : Visited::kStop;
}

}  // namespace tumblesight::gnc
