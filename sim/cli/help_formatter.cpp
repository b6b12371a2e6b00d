#include "sim/cli/help_formatter.hpp"

#include <sstream>

#include "sim/host/text.hpp"

namespace tumblesight::sim {

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  return wrapped(Formatter::make_option_desc(option), kHelpWidth - column_width_);
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  std::ostringstream out;
  CLI::detail::format_help(out, command->get_name(),
                           wrapped(command->get_description(), kHelpWidth - column_width_), column_width_);
  return out.str();
}

}  // namespace tumblesight::sim
