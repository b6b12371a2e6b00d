// tumblesight evaluate: accuracy of a model over many sequences, straight from renderer to estimator.
#pragma once

#include <CLI/CLI.hpp>

namespace tumblesight::sim {

void add_evaluate_command(CLI::App& app);

}  // namespace tumblesight::sim
