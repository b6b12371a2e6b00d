// The layout of help texts: descriptions are wrapped to a terminal of 80 columns.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>

namespace tumblesight::sim {

inline constexpr std::size_t kHelpWidth = 80;  // columns

class HelpFormatter final : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(26); }
  std::string make_option_desc(const CLI::Option* option) const override;
  std::string make_subcommand(const CLI::App* command) const override;
};

}  // namespace tumblesight::sim
