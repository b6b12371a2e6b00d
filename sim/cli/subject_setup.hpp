// Makes the subject of an experiment from arguments.
#pragma once

#include "sim/cli/arguments.hpp"
#include "sim/evaluation/experiment.hpp"

namespace tumblesight::sim {

// Prints warnings about the mesh and the model to the standard error stream. Throws as set_up_target does,
// and std::runtime_error that gives the reason if the model image is refused.
Subject set_up_subject(const ScenarioArguments& arguments);

}  // namespace tumblesight::sim
