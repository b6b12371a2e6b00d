// --symmetry: turns after which the target looks the same.
#pragma once

#include "sim/cli/command.hpp"
#include "sim/evaluation/target_symmetry.hpp"

namespace tumblesight::sim {

// `symmetry` must outlive the parsing.
void add_symmetry_option(Command& command, TargetSymmetry& symmetry);

// A line on the terminal; none without a symmetry.
void print_symmetry(const TargetSymmetry& symmetry);

}  // namespace tumblesight::sim
