// Measured peak rate of this core's multiply-accumulate instructions: independent chains in registers, no
// memory access.
#pragma once

#include <cstdint>
#include <optional>

#include "gnc/numerics/instruction_set.hpp"

namespace tumblesight::sim {

// Multiply-accumulates per second, for the instructions that the kernels of this set use in convolutions.
// nullopt if the processor lacks the set or there is no measurement for it. `is_integer`: fixed point, else
// float32.
std::optional<double> measured_peak_macs(gnc::InstructionSet set, bool is_integer);

// Chains of multiply-accumulates, one source file per instruction set (peak/).
namespace peak {

struct Chains {
  void (*run)(std::uint64_t rounds);
  double macs_per_round;
};

extern const Chains kFixedAvx2, kFixedAvxVnni, kFixedAvx512Vnni, kFloatSse2, kFloatAvx2, kFloatAvx512;

}  // namespace peak

}  // namespace tumblesight::sim
