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
    sum = _mm512_add_ps(sum, _mm512_mul_ps(a, b));  // rounded each, as the float32 kernels do
  }
};

void fixed_point(std::uint64_t rounds) {
  run_chains<Int8>(rounds);
}
void float32(std::uint64_t rounds) {
  run_chains<Float>(rounds);
}

}  // namespace

const Chains kFixedAvx512Vnni{fixed_point, kMacsARound<Int8>};
const Chains kFloatAvx512{float32, kMacsARound<Float>};

}  // namespace tumblesight::sim::peak
