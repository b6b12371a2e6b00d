#include "sim/cli/command_line.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "sim/cli/exit_status.hpp"
#include "sim/cli/help_formatter.hpp"
#include "sim/cli/parse_faults.hpp"
#include "sim/cli/version_text.hpp"

namespace tumblesight::sim {
namespace {

void parse_words(CLI::App& app, const std::vector<std::string>& words) {
  app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // as CLI11 takes them
}

}  // namespace

CommandLine::CommandLine() : app_(std::make_unique<CLI::App>()), command_(*app_) {}

CommandLine::CommandLine(const std::string& summary, const std::string& help_of_version)
    : app_(std::make_unique<CLI::App>(summary, "tumblesight")), command_(*app_) {
  app_->set_version_flag("--version", version_text(), help_of_version);
  app_->require_subcommand(1);
  app_->formatter(std::make_shared<HelpFormatter>());
}

CommandLine::~CommandLine() = default;

void CommandLine::parse(const std::vector<std::string>& words) {
  try {
    parse_words(*app_, words);
  } catch (const CLI::ParseError& error) {
    throw ArgumentFault(error.what());
  }
}

int CommandLine::run(const std::vector<std::string>& words) {
  try {
    parse_words(*app_, words);
  } catch (const CLI::ParseError& error) {
    const bool is_answer = error.get_exit_code() == 0;  // --help, --version
    return is_answer ? app_->exit(error) : report_fault(fault_of_parsing(*app_, error));
  } catch (const ArgumentFault& fault) {
    return report_fault(with_help(*app_, fault.what()));
  } catch (const Exit& exit) {
    return exit.status;
  }
  return 0;
}

int report_fault(const std::string& fault) {
  std::fprintf(stderr, "tumblesight: %s\n", fault.c_str());
  return kBadArguments;
}

}  // namespace tumblesight::sim
