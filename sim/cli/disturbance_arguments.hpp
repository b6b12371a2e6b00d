// The options that disturb a run, the same for every verb that runs sequences.
#pragma once

#include <cstdint>
#include <string>

#include "sim/cli/command.hpp"
#include "sim/world/scenario/disturbance.hpp"

namespace tumblesight::sim {

// One option per row of kDisturbances. `disturbances` must outlive the parsing.
void add_disturbance_options(Command& command, Disturbances& disturbances);

// For the end of a help text: how the options work together, and examples for `verb`.
std::string disturbance_examples(const std::string& verb);

// Throws ArgumentFault if a sequence of `frames` frames is too short for the disturbances.
void require_possible_disturbances(const Disturbances& disturbances, std::uint32_t frames);

}  // namespace tumblesight::sim
