// From arguments to what an experiment measures.
#pragma once

#include "sim/cli/arguments.hpp"
#include "sim/evaluation/experiment.hpp"

namespace tumblesight::sim {

// Prints what a user should know of the mesh and the model on the standard error stream. Throws as
// set_up_target does, and std::runtime_error that names the fault of a model image that is refused.
Subject set_up_subject(const ScenarioArguments& arguments);

}  // namespace tumblesight::sim
