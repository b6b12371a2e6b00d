#include "sim/bench/peak/chains.hpp"

namespace tumblesight::sim::peak {
namespace {

struct Int8 {
  using Vector = __m512i;
  static constexpr double kMacs = 64;
  [[gnu::always_inline]] static inline void add(Vector& sum, Vector a, Vector b) {
    sum = _mm512_dpbusd_epi32(sum, a, b);
  }
};
struct Float {
  using Vector = __m512;
  static constexpr double kMacs = 16;
  [[gnu::always_inline]] static inline void add(Vector& sum, Vector a, Vector b) {
    sum = _mm512_add_ps(sum, _mm512_mul_ps(a, b));  // two roundings, as in the float32 kernels
  }
};

void fixed_point(std::uint64_t rounds) {
  run_chains<Int8>(rounds);
}
void float32(std::uint64_t rounds) {
  run_chains<Float>(rounds);
}

}  // namespace

const Chains kFixedAvx512Vnni{fixed_point, kMacsPerRound<Int8>};
const Chains kFloatAvx512{float32, kMacsPerRound<Float>};

}  // namespace tumblesight::sim::peak
