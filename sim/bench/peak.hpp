// What this core's multiply-accumulate instructions give at most, measured: independent chains in registers,
// no memory.
#pragma once

#include <optional>

#include "gnc/numerics/instruction_set.hpp"

namespace tumblesight::sim {

// Multiply-accumulates a second of the instructions that the kernels of this set use for convolutions;
// nothing where there is no measurement. `is_integer`: fixed point, else float32.
std::optional<double> measured_peak_macs(gnc::InstructionSet set, bool is_integer);

}  // namespace tumblesight::sim
