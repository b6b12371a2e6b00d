// The subject of an experiment, made from arguments.
#pragma once

#include "sim/cli/arguments.hpp"
#include "sim/evaluation/experiment.hpp"

namespace tumblesight::sim {

// Prints the warnings of set_up_target on the standard error stream. Throws as set_up_target does, and
// std::runtime_error that names the fault of a model image that is refused.
Subject set_up_subject(const ScenarioArguments& arguments);

}  // namespace tumblesight::sim
