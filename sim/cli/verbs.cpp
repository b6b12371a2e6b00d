#include "sim/cli/verbs.hpp"

#include "sim/cli/verb_table.hpp"

namespace tumblesight::sim {

Command add_verb(Command& app, const char* name) {
  return app.add_subcommand(name, verb_named(name)->summary);
}

}  // namespace tumblesight::sim
