#include "sim/bench/peak/chains.hpp"

namespace tumblesight::sim::peak {
namespace {

struct Float {
  using Vector = __m128;
  static constexpr double kMacs = 4;
  [[gnu::always_inline]] static inline void add(Vector& sum, Vector a, Vector b) {
    sum = _mm_add_ps(sum, _mm_mul_ps(a, b));  // two roundings, as in the float32 kernels
  }
};

void float32(std::uint64_t rounds) {
  run_chains<Float>(rounds);
}

}  // namespace

const Chains kFloatSse2{float32, kMacsPerRound<Float>};

}  // namespace tumblesight::sim::peak
