#include "gnc/registration/reciprocal.hpp"

namespace tumblesight::gnc {

constexpr std::array<std::int32_t, 256> kReciprocal_q28 = [] {
  std::array<std::int32_t, 256> guess{};
  for (int i = 32; i < 256; ++i)
    guess[static_cast<std::size_t>(i)] = static_cast<std::int32_t>((std::int64_t{256} << 28) / (2 * i + 1));
  return guess;
}();

}  // namespace tumblesight::gnc
