// tumblesight record: rendered frames as a recording, for the flight application on a machine without
// simulator.
#pragma once

#include <CLI/CLI.hpp>

namespace tumblesight::sim {

void add_record_command(CLI::App& app);

}  // namespace tumblesight::sim
