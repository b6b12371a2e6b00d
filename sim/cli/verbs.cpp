#include "sim/cli/verbs.hpp"

#include <CLI/CLI.hpp>

#include "sim/cli/verb_table.hpp"

namespace tumblesight::sim {

CLI::App* add_verb(CLI::App& app, const char* name) {
  return app.add_subcommand(name, verb_named(name)->summary);
}

}  // namespace tumblesight::sim
