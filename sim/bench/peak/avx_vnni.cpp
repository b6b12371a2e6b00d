#include "sim/bench/peak/chains.hpp"

namespace tumblesight::sim::peak {
namespace {

struct Int8 {
  using Vector = __m256i;
  static constexpr double kMacs = 32;
  [[gnu::always_inline]] static inline void add(Vector& sum, Vector a, Vector b) {
    sum = _mm256_dpbusd_avx_epi32(sum, a, b);
  }
};

void fixed_point(std::uint64_t rounds) {
  run_chains<Int8>(rounds);
}

}  // namespace

const Chains kFixedAvxVnni{fixed_point, kMacsPerRound<Int8>};

}  // namespace tumblesight::sim::peak
