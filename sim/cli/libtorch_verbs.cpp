#include "sim/cli/verbs.hpp"

namespace tumblesight::sim {

void add_libtorch_verbs(CLI::App& app, const std::string& command_line) {
#ifdef TUMBLESIGHT_HAS_ADOPTION
  add_adopt_command(app, command_line);
#endif
#ifdef TUMBLESIGHT_HAS_TRAINING
  add_train_command(app);
#endif
  add_bench_command(app);
  static_cast<void>(command_line);  // no verb of a build without training takes it
}

}  // namespace tumblesight::sim
