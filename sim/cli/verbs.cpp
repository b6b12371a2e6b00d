#include "sim/cli/verbs.hpp"

namespace tumblesight::sim {

void add_verbs(CLI::App& app, const std::string& command_line) {
#ifdef TUMBLESIGHT_HAS_SIL
  add_simulate_command(app, command_line);
  add_replay_command(app, command_line);
#endif
#ifdef TUMBLESIGHT_HAS_CONSOLE
  add_console_command(app);
#endif
  add_mesh_command(app, command_line);
  add_evaluate_command(app, command_line);
  add_merge_command(app);
  add_campaign_command(app, command_line);
  add_quantize_command(app);
  add_record_command(app);
#ifdef TUMBLESIGHT_HAS_ONNX
  add_export_command(app);
#endif
}

}  // namespace tumblesight::sim
