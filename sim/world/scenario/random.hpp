// Random numbers that are the same on every machine and with any number of threads: each value is a hash of
// what it is for (seed, index, ...), not the next of a shared stream.
#pragma once

#include <cmath>
#include <cstdint>

namespace tumblesight::sim {

// SplitMix64's finaliser: a bijection of 64 bits that passes the usual statistical batteries.
inline std::uint64_t mix(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

inline std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
  return mix(mix(a) ^ (b * 0xD1342543DE82EF95ULL + 1));
}

// A short stream of its own for one purpose.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  double uniform() { return (static_cast<double>(next() >> 11) + 0.5) * 0x1.0p-53; }  // (0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double normal() {  // Box-Muller, one of the pair
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return radius * std::cos(6.283185307179586 * uniform());
  }
  std::uint64_t next() { return mix(state_++); }

 private:
  std::uint64_t state_;
};

}  // namespace tumblesight::sim
