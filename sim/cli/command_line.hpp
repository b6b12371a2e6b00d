// A command line: its options, and what becomes of the words that it is given.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "sim/cli/command.hpp"

namespace tumblesight::sim {

inline constexpr std::size_t kHelpWidth = 80;  // columns of help texts

class CommandLine {
 public:
  // Options alone, without a program, for words that stand elsewhere than on a command line.
  CommandLine();
  // The tool, which needs a subcommand. The summary and the help of --version are in its help.
  CommandLine(const std::string& summary, const std::string& help_of_version);
  ~CommandLine();

  Command& command() { return command_; }

  // Takes words, without the name of the program, and does what the callbacks do. Throws ArgumentFault if one
  // is wrong.
  void parse(const std::vector<std::string>& words);
  // The same for the words of a user. Prints help, version, or what is wrong. Returns the exit status.
  int run(const std::vector<std::string>& words);

 private:
  std::unique_ptr<CLI::App> app_;
  Command command_;
};

// Prints a fault of an argument and returns its exit status.
int report_fault(const std::string& fault);

}  // namespace tumblesight::sim
