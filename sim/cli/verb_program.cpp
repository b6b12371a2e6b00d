#include "sim/cli/verb_program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <typeinfo>

#include "sim/cli/exit_status.hpp"
#include "sim/cli/help_formatter.hpp"
#include "sim/cli/parse_faults.hpp"
#include "sim/cli/version_text.hpp"
#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

// Arguments end up in reports and JSON.
void require_utf8(const std::vector<std::string>& arguments) {
  for (const std::string& argument : arguments)
    if (!is_utf8(argument))
      throw CLI::ValidationError(
          fmt::format("argument '{}'", shortened(argument)),
          "is not UTF-8, which reports and JSON are written in; if it is a file, give it another name");
}

int report(const CLI::App& app, const CLI::ParseError& error) {
  // --help, and commands that have already reported their failure.
  if (error.get_exit_code() == 0 || error.get_name() == "RuntimeError") return app.exit(error);
  return report_fault(fault_of_parsing(app, error));
}

std::vector<std::string> arguments_of(int argc, char** argv, const std::string& verb) {
  std::vector<std::string> arguments(argv + 1, argv + std::max(argc, 1));
  if (arguments.empty() || arguments.front() != verb) arguments.insert(arguments.begin(), verb);
  return arguments;
}

void parse(CLI::App& app, std::vector<std::string> arguments, AddCommand& add_command) {
  require_utf8(arguments);
  std::string command_line = "tumblesight";
  for (const std::string& argument : arguments) command_line += " " + shell_word(argument);
  add_command(app, command_line);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
  app.parse(std::move(arguments));
}

}  // namespace

int report_fault(const std::string& fault) {
  std::fprintf(stderr, "tumblesight: %s\n", fault.c_str());
  return kBadArguments;
}

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
  CLI::App app;
  app.name("tumblesight");
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  app.formatter(std::make_shared<HelpFormatter>());
  try {
    parse(app, arguments_of(argc, argv, verb), add_command);
  } catch (const CLI::ParseError& error) {
    return finish_output(report(app, error));
  } catch (const std::exception& error) {
    // fmt::print() does not say to what it could not write.
    const bool is_of_output = typeid(error) == typeid(std::system_error) && std::ferror(stdout) != 0;
    std::fprintf(stderr, "tumblesight: %s%s\n", is_of_output ? "standard output: " : "", error.what());
    return kFailed;
  }
  return finish_output(0);
}

}  // namespace tumblesight::sim
