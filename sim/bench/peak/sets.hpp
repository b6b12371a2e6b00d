// Chains of multiply-accumulates, one source file per instruction set.
#pragma once

#include <cstdint>

namespace tumblesight::sim::peak {

struct Chains {
  void (*run)(std::uint64_t rounds);
  double macs_per_round;
};

extern const Chains kFixedAvx2, kFixedAvxVnni, kFixedAvx512Vnni, kFloatSse2, kFloatAvx2, kFloatAvx512;

}  // namespace tumblesight::sim::peak
