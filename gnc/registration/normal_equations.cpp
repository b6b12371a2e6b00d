#include "gnc/registration/normal_equations.hpp"

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"
#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kFactorBits = 22;

// value * 2^left, limited to +-2^62.
std::int64_t shifted(std::int64_t value, int left) {
  if (left < 0) return value >> -left;
  const std::int64_t most = (std::int64_t{1} << 62) >> left;
  return clamp(value, -most, most) * (std::int64_t{1} << left);
}

}  // namespace

template <int N>
std::array<std::int32_t, N> solve(const std::array<std::int64_t, N*(N + 1) / 2>& information,
                                  const std::array<std::int64_t, N>& gradient) {
  // Scaled so that the largest element of the diagonal has 31 bits.
  std::int64_t largest = 1;
  for (int i = 0; i < N; ++i) largest = max(largest, information[element(i, i)]);
  const int left = 30 - highest_bit(static_cast<std::uint64_t>(largest));

  // L D L^T (Cholesky without square roots), L with kFactorBits fraction bits.
  std::array<std::int64_t, N*(N + 1) / 2> factor{};
  std::array<std::int64_t, N> diagonal{};
  for (int i = 0; i < N; ++i) {
    std::array<std::int64_t, N> scaled{};  // L_ik D_k
    for (int j = 0; j < i; ++j) {
      std::int64_t sum = shifted(information[element(i, j)], left);
      for (int k = 0; k < j; ++k)
        sum -= (scaled[static_cast<std::size_t>(k)] * factor[element(j, k)]) >> kFactorBits;
      constexpr std::int64_t kMostOfSum = std::int64_t{1} << 32;
      sum = clamp(sum, -kMostOfSum, kMostOfSum);
      scaled[static_cast<std::size_t>(j)] = sum;
      constexpr std::int64_t kLargest = std::int64_t{1} << 30;
      factor[element(i, j)] =
          clamp(divide(sum * (std::int64_t{1} << kFactorBits), diagonal[static_cast<std::size_t>(j)]),
                -kLargest, kLargest);
    }
    std::int64_t sum = shifted(information[element(i, i)], left);
    for (int k = 0; k < i; ++k)
      sum -= (scaled[static_cast<std::size_t>(k)] * factor[element(i, k)]) >> kFactorBits;
    diagonal[static_cast<std::size_t>(i)] = max<std::int64_t>(sum, 1 << 10);
  }

  constexpr std::int64_t kMost = std::int64_t{1} << 32;
  std::array<std::int64_t, N> x{};
  for (int i = 0; i < N; ++i) {
    std::int64_t sum = clamp(shifted(gradient[static_cast<std::size_t>(i)], left), -kMost, kMost);
    for (int k = 0; k < i; ++k)
      sum -= (factor[element(i, k)] * x[static_cast<std::size_t>(k)]) >> kFactorBits;
    x[static_cast<std::size_t>(i)] = clamp(sum, -kMost, kMost);
  }
  constexpr std::int64_t kLimit = std::int64_t{1} << 30;
  for (std::size_t i = 0; i < N; ++i)
    x[i] = clamp(divide(x[i] * (std::int64_t{1} << 24), diagonal[i]), -kLimit, kLimit);
  std::array<std::int32_t, N> motion{};
  for (int i = N - 1; i >= 0; --i) {
    std::int64_t sum = x[static_cast<std::size_t>(i)];
    for (int k = i + 1; k < N; ++k)
      sum -= (factor[element(k, i)] * motion[static_cast<std::size_t>(k)]) >> kFactorBits;
    motion[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(clamp(sum, -kLimit, kLimit));
  }
  return motion;
}

template std::array<std::int32_t, 6> solve<6>(const std::array<std::int64_t, 21>&,
                                              const std::array<std::int64_t, 6>&);
template std::array<std::int32_t, 12> solve<12>(const std::array<std::int64_t, 78>&,
                                                const std::array<std::int64_t, 12>&);

}  // namespace tumblesight::gnc
