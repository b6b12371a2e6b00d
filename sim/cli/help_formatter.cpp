#include "sim/cli/help_formatter.hpp"

#include <algorithm>
#include <sstream>

namespace tumblesight::sim {
namespace {

// One per character: the bytes that do not continue one.
std::size_t columns_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

std::string wrapped(const std::string& text, std::size_t columns) {
  std::string result;
  std::size_t used = 0;  // columns of the last line
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::size_t width = columns_of(word);
    const bool fits = used + 1 + width <= columns;
    if (used > 0) result += fits ? ' ' : '\n';
    used = used > 0 && fits ? used + 1 + width : width;
    result += word;
  }
  return result;
}

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
