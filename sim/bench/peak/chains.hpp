// Independent chains of one instruction sequence, enough of them to hide its latency.
#pragma once

#include <immintrin.h>

#include "sim/bench/peak.hpp"

namespace tumblesight::sim::peak {
namespace {

constexpr int kChains = 12;

// Step: a Vector type, its kMacs, and `static void add(Vector& sum, Vector a, Vector b)`.
template <class Step>
[[gnu::always_inline]] inline void run_chains(std::uint64_t rounds) {
  typename Step::Vector sum[kChains] = {};
  typename Step::Vector a = {}, b = {};
  asm volatile("" : "+x"(b));  // the compiler must not know its value
  for (std::uint64_t i = 0; i < rounds; ++i) {
#pragma GCC unroll 12
    for (int chain = 0; chain < kChains; ++chain) {
      asm volatile("" : "+x"(a));  // nor assume that it stays the same
      Step::add(sum[chain], a, b);
    }
  }
#pragma GCC unroll 12
  for (int chain = 0; chain < kChains; ++chain)
    asm volatile("" : : "x"(sum[chain]));  // keeps the results alive
}

template <class Step>
constexpr double kMacsPerRound = kChains* Step::kMacs;

}  // namespace
}  // namespace tumblesight::sim::peak
