// `tumblesight record`: renders frames into a recording, for the flight application on boards without a
// simulator.
#pragma once

#include <CLI/CLI.hpp>

namespace tumblesight::sim {

void add_record_command(CLI::App& app);

}  // namespace tumblesight::sim
