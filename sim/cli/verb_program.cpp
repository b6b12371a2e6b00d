#include "sim/cli/verb_program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <string>
#include <system_error>
#include <typeinfo>

#include "sim/cli/command_line.hpp"
#include "sim/cli/exit_status.hpp"
#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

// Arguments end up in reports and JSON.
std::string fault_of_encoding(const std::vector<std::string>& arguments) {
  for (const std::string& argument : arguments)
    if (!is_utf8(argument))
      return fmt::format(
          "argument '{}': is not UTF-8, which reports and JSON are written in; if it is a file, give it "
          "another name",
          shortened(argument));
  return {};
}

std::vector<std::string> arguments_of(int argc, char** argv, const std::string& verb) {
  std::vector<std::string> arguments(argv + 1, argv + std::max(argc, 1));
  if (arguments.empty() || arguments.front() != verb) arguments.insert(arguments.begin(), verb);
  return arguments;
}

std::string command_line_of(const std::vector<std::string>& arguments) {
  std::string text = "tumblesight";
  for (const std::string& argument : arguments) text += " " + shell_word(argument);
  return text;
}

}  // namespace

void prepare_program() {
  std::signal(SIGXFSZ, SIG_IGN);
  // Opened for reading, so that writing to it still fails.
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
    if (fcntl(stream, F_GETFD) < 0) (void)open("/dev/null", O_RDONLY);  // takes the lowest number
}

int finish_output(int status) {
  const bool written = std::cout.flush().good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (written) return status;
  std::fprintf(stderr, "tumblesight: standard output: %s\n", std::strerror(errno));
  return status == 0 ? kFailed : status;
}

int run_verb_program(int argc, char** argv, const char* verb, AddCommand& add_command) {
  prepare_program();
  CommandLine line("", "");
  const std::vector<std::string> arguments = arguments_of(argc, argv, verb);
  int status = 0;
  try {
    if (const std::string fault = fault_of_encoding(arguments); !fault.empty())
      return finish_output(report_fault(fault + " (see tumblesight --help)"));
    add_command(line.command(), command_line_of(arguments));
    status = line.run(arguments);
  } catch (const std::exception& error) {
    // fmt::print() does not say to what it could not write.
    const bool is_of_output = typeid(error) == typeid(std::system_error) && std::ferror(stdout) != 0;
    std::fprintf(stderr, "tumblesight: %s%s\n", is_of_output ? "standard output: " : "", error.what());
    return kFailed;
  }
  return finish_output(status);
}

}  // namespace tumblesight::sim
