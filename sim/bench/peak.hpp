// Measured peak rate of this core's multiply-accumulate instructions: independent chains in registers, no
// memory access.
#pragma once

#include <optional>

#include "gnc/numerics/instruction_set.hpp"

namespace tumblesight::sim {

// Multiply-accumulates per second, for the instructions that the kernels of this set use in convolutions.
// nullopt if the processor lacks the set or there is no measurement for it. `is_integer`: fixed point, else
// float32.
std::optional<double> measured_peak_macs(gnc::InstructionSet set, bool is_integer);

}  // namespace tumblesight::sim
