// What is wrong with a command line, in one line that names the word and, where one is near, the word that
// was meant.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace tumblesight::sim {

// The line of a command line that `app` refused with `error`, without the name of the program at its
// beginning.
std::string fault_of_parsing(const CLI::App& app, const CLI::ParseError& error);

}  // namespace tumblesight::sim
