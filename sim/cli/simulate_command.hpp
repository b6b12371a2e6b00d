// `tumblesight simulate`: a software-in-the-loop run with the flight program, with figures and a report.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace tumblesight::sim {

// `command_line` is shown in the report.
void add_simulate_command(CLI::App& app, const std::string& command_line);

}  // namespace tumblesight::sim
