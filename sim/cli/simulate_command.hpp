// tumblesight simulate: a software-in-the-loop run against the flight program, with figures and a report.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace tumblesight::sim {

// `command_line`: for the record in the report.
void add_simulate_command(CLI::App& app, const std::string& command_line);

}  // namespace tumblesight::sim
