#include "sim/cli/command_line.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <sstream>

#include "sim/cli/exit_status.hpp"
#include "sim/cli/version_text.hpp"
#include "sim/host/nearest_name.hpp"
#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

// Descriptions are wrapped to a terminal's columns.
class HelpFormatter final : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(26); }

  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(Formatter::make_option_desc(option), kHelpWidth - column_width_);
  }

  std::string make_subcommand(const CLI::App* command) const override {
    std::ostringstream out;
    CLI::detail::format_help(out, command->get_name(),
                             wrapped(command->get_description(), kHelpWidth - column_width_), column_width_);
    return out.str();
  }
};

// The command that was parsed last: that of the innermost verb. With what the user typed for it.
const CLI::App& innermost(const CLI::App& app, std::string& typed) {
  typed = app.get_name();
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) {
    command = command->get_subcommands().front();
    typed += " " + command->get_name();
  }
  return *command;
}

std::vector<std::string> verbs_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* verb : command.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(verb->get_name());
  return names;
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

bool is_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && (word[1] < '0' || word[1] > '9') && word != "--";
}

// Before what is missing: the wrong word may be the missing one.
std::string unknown_word(const CLI::App& app, const CLI::App& command, const std::string& typed) {
  for (const std::string& word : app.remaining(true)) {
    if (is_option(word)) {
      const std::string option = word.substr(0, word.find('='));
      return "there is no option '" + shortened(option) + "'" + did_you_mean(option, options_of(command));
    }
    const std::vector<std::string> verbs = verbs_of(command);
    if (verbs.empty()) continue;
    const std::string before =
        typed.find(' ') == std::string::npos ? "" : typed.substr(typed.find(' ') + 1) + " ";
    return "there is no subcommand '" + before + shortened(word) + "'" + did_you_mean(word, verbs);
  }
  return {};
}

// A fault with the command whose --help explains it: the one that was parsed last.
std::string with_help(const CLI::App& app, const std::string& fault) {
  std::string typed;
  (void)innermost(app, typed);
  return fault + " (see " + typed + " --help)";
}

// Names the word that is wrong and, where one is near, the word that was meant.
std::string fault_of_parsing(const CLI::App& app, const CLI::ParseError& error) {
  std::string typed;
  const CLI::App& command = innermost(app, typed);
  const auto code = static_cast<CLI::ExitCodes>(error.get_exit_code());
  const bool may_be_misspelt = code == CLI::ExitCodes::RequiredError || code == CLI::ExitCodes::ExtrasError ||
                               code == CLI::ExitCodes::RequiresError;
  const std::string fault = may_be_misspelt ? unknown_word(app, command, typed) : "";
  return with_help(app, fault.empty() ? error.what() : fault);
}

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
