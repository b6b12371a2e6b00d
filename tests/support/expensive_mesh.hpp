// The most expensive surfaces that a model image can have, for tests of the bound of a step's work: as many
// vertices, triangles and edges as the format allows, all of them in sight at once. No heap, so that the
// audit runs it on every processor.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/surface/surface_mesh.hpp"

namespace tumblesight::gnc {

// A sheet across the boresight, a grid of 48 x 64 vertices, whose triangles are `reach` rows of the grid
// high: the higher, the more of them lie upon each other.
struct ExpensiveMesh {
  int reach = 1;
  int half_side = 20'000;  // in SurfaceMesh::kRadius
  bool shows_both_sides = false;
};

// `section`: SurfaceMesh::kMaxBytes, all of which are written.
inline void make_expensive_mesh(const ExpensiveMesh& wanted, std::uint8_t* section) {
  constexpr int kRows = 48, kColumns = 64;
  static_assert(kRows * kColumns == SurfaceMesh::kMaxVertices);
  const auto put = [&section](int value) {
    *section++ = static_cast<std::uint8_t>(value);
    *section++ = static_cast<std::uint8_t>(value >> 8);
  };
  for (const int count : {SurfaceMesh::kMaxVertices, SurfaceMesh::kMaxTriangles, SurfaceMesh::kMaxEdges, 0})
    put(count);
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      put(wanted.half_side * (2 * column - kColumns + 1) / (kColumns - 1));
      put((row * 37 + column * 23) %
          64);  // nearly a plane: where triangles overlap, another one is the nearest
      put(wanted.half_side * (2 * row - kRows + 1) / (kRows - 1));
    }
  }
  const auto number = [](int row, int column) { return row * kColumns + column; };
  // Counterclockwise as seen from -y, from where the sensor looks.
  for (int i = 0; i < SurfaceMesh::kMaxTriangles; ++i) {
    const int at = (wanted.shows_both_sides ? i / 4 : i / 2) % ((kRows - wanted.reach) * (kColumns - 1));
    const int row = at / (kColumns - 1), column = at % (kColumns - 1);
    const bool is_upper = i % 2 != 0, is_back = wanted.shows_both_sides && i % 4 >= 2;
    const int a = number(row, column), b = number(row, column + 1);
    const int c = number(row + wanted.reach, column), d = number(row + wanted.reach, column + 1);
    const std::array<int, 3> corners = is_upper ? std::array<int, 3>{b, d, c} : std::array<int, 3>{a, b, c};
    put(corners[0]);
    put(corners[is_back ? 2 : 1]);
    put(corners[is_back ? 1 : 2]);
  }
  // All edges are on the silhouette, and it is followed again and again.
  constexpr int kAround = 2 * (kRows - 1) + 2 * (kColumns - 1);
  for (int i = 0; i < SurfaceMesh::kMaxEdges; ++i) {
    const int at = i % kAround;
    int first = 0, second = 0, inner = 0;
    if (at < 2 * (kRows - 1)) {
      const int row = at / 2, column = at % 2 != 0 ? kColumns - 1 : 0;
      first = number(row, column);
      second = number(row + 1, column);
      inner = number(row, column == 0 ? 1 : column - 1);
    } else {
      const int along = at - 2 * (kRows - 1), column = along / 2, row = along % 2 != 0 ? kRows - 1 : 0;
      first = number(row, column);
      second = number(row, column + 1);
      inner = number(row == 0 ? 1 : row - 1, column);
    }
    for (const int corner : {first, second, inner, inner}) put(corner);
  }
}

}  // namespace tumblesight::gnc
