// `tumblesight evaluate`: accuracy of a model over many sequences, from the renderer directly to the
// estimator.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace tumblesight::sim {

// `command_line` is shown in the report.
void add_evaluate_command(CLI::App& app, const std::string& command_line);

}  // namespace tumblesight::sim
