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
  const int larger = row >= column ? row : column, smaller = row + column - larger;
  return element(larger, smaller);
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
      const auto weighted = static_cast<std::int32_t>((row[at] * std::int64_t{weight} + (1 << 11)) >> 12);
#pragma GCC unroll 6
      for (int k = 0; k <= i; ++k)
        information[element(i, k)] += row[static_cast<std::size_t>(k)] * std::int64_t{weighted};
      gradient[at] += row[at] * std::int64_t{wanted};
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
