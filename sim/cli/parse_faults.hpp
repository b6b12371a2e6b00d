// What is wrong with a command line, in one line that names the word and, where one is near, the word that
// was meant.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace tumblesight::sim {

// The line of a command line that `app` refused with `error`, without the name of the program at its
// beginning.
std::string fault_of_parsing(const CLI::App& app, const CLI::ParseError& error);

// A fault with the command whose --help explains it: the one that was parsed last.
std::string with_help(const CLI::App& app, const std::string& fault);

}  // namespace tumblesight::sim
