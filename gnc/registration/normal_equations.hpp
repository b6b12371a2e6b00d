// NormalEquations: weighted least squares for a small motion of the target, six unknowns: its turn about the
// TRF's origin [rad], then the move of that origin [target radii], both in the axes of the LRF.
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::gnc {

inline constexpr int kUnknowns = 6;
inline constexpr int kElements = kUnknowns * (kUnknowns + 1) / 2;

// Index of an element of a symmetric matrix of which the lower triangle is stored; column <= row.
constexpr std::size_t element(int row, int column) {
  const int index = row * (row + 1) / 2 + column;
  return static_cast<std::size_t>(index);
}
// The same for any row and column.
constexpr std::size_t symmetric_element(int row, int column) {
  return row >= column ? element(row, column) : element(column, row);
}

struct NormalEquations {
  std::array<std::int64_t, kElements> information{};  // lower triangle
  std::array<std::int64_t, kUnknowns> gradient{};

  // Adds `weight` * row row^T and `wanted` * row. `weight`: Q12; its product with an element of the row is
  // rounded to a whole number, so that every further product is one of 32 bits.
  void add(const std::array<std::int32_t, kUnknowns>& row, std::int32_t weight, std::int32_t wanted) {
    // Without loops at run time, which would take longer than the sums.
#pragma GCC unroll 6
    for (int i = 0; i < kUnknowns; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const auto weighted = static_cast<std::int32_t>((std::int64_t{weight} * row[at] + (1 << 11)) >> 12);
#pragma GCC unroll 6
      for (int k = 0; k <= i; ++k)
        information[element(i, k)] += std::int64_t{weighted} * row[static_cast<std::size_t>(k)];
      gradient[at] += std::int64_t{wanted} * row[at];
    }
  }
};

// The solution x of information x = gradient, with 24 fraction bits, each element limited to +-2^30.
// `information`: lower triangle. It must be positive definite with a condition below 2^20 and diagonal
// elements within a factor of 2^16; other matrices give a solution without a meaning. N: 6 or 12.
template <int N>
std::array<std::int32_t, N> solve(const std::array<std::int64_t, N*(N + 1) / 2>& information,
                                  const std::array<std::int64_t, N>& gradient);

using Motion6 = std::array<std::int32_t, kUnknowns>;  // Q24
inline Motion6 solve(const NormalEquations& equations) {
  return solve<kUnknowns>(equations.information, equations.gradient);
}

}  // namespace tumblesight::gnc
