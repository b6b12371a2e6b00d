// The verbs of `tumblesight` that this build has, in the order in which --help lists them.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace tumblesight::sim {

// Adds every verb to `app`. `command_line`: what the user typed, for reports that name it.
void add_verbs(CLI::App& app, const std::string& command_line);

}  // namespace tumblesight::sim
