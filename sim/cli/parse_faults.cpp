#include "sim/cli/parse_faults.hpp"

#include <CLI/CLI.hpp>
#include <vector>

#include "sim/host/nearest_name.hpp"
#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

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

}  // namespace

std::string fault_of_parsing(const CLI::App& app, const CLI::ParseError& error) {
  std::string typed;
  const CLI::App& command = innermost(app, typed);
  const auto code = static_cast<CLI::ExitCodes>(error.get_exit_code());
  const bool may_be_misspelt = code == CLI::ExitCodes::RequiredError || code == CLI::ExitCodes::ExtrasError ||
                               code == CLI::ExitCodes::RequiresError;
  const std::string fault = may_be_misspelt ? unknown_word(app, command, typed) : "";
  return with_help(app, fault.empty() ? error.what() : fault);
}

std::string with_help(const CLI::App& app, const std::string& fault) {
  std::string typed;
  (void)innermost(app, typed);
  return fault + " (see " + typed + " --help)";
}

}  // namespace tumblesight::sim
