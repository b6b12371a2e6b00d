// Random numbers that are the same on every machine and with any number of threads: each value is a hash of
// its purpose (seed, index, ...), not the next value of a shared stream.
#pragma once

#include <cmath>
#include <cstdint>

namespace tumblesight::sim {

// Finalizer of SplitMix64 (Steele, Lea and Flood, 2014): a bijection of 64 bits that passes the usual
// statistical test batteries.
inline std::uint64_t mix(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

// Hash of an ordered pair: the seed of purpose `b` derived from seed `a`.
inline std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
  return mix(mix(a) ^ (b * 0xD1342543DE82EF95ULL + 1));
}

// A short stream for one purpose. The same seed gives the same values on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  double uniform() { return (static_cast<double>(next() >> 11) + 0.5) * 0x1.0p-53; }  // open interval (0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double normal() {  // standard normal: Box-Muller, first value of the pair
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return radius * std::cos(6.283185307179586 * uniform());
  }
  std::uint64_t next() { return mix(state_++); }

 private:
  std::uint64_t state_;
};

}  // namespace tumblesight::sim
