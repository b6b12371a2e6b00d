#include "sim/cli/verbs.hpp"

#include "sim/cli/bench_command.hpp"
#include "sim/cli/evaluate_command.hpp"
#include "sim/cli/quantize_command.hpp"
#include "sim/cli/record_command.hpp"
#ifdef TUMBLESIGHT_HAS_ONNX
#include "sim/cli/export_command.hpp"
#endif
#ifdef TUMBLESIGHT_HAS_SIL
#include "sim/cli/simulate_command.hpp"
#endif
#ifdef TUMBLESIGHT_HAS_TRAINING
#include "sim/cli/train_command.hpp"
#endif

namespace tumblesight::sim {

void add_verbs(CLI::App& app, const std::string& command_line) {
#ifdef TUMBLESIGHT_HAS_SIL
  add_simulate_command(app, command_line);
#endif
  add_evaluate_command(app, command_line);
  add_quantize_command(app);
  add_record_command(app);
  add_bench_command(app);
#ifdef TUMBLESIGHT_HAS_ONNX
  add_export_command(app);
#endif
#ifdef TUMBLESIGHT_HAS_TRAINING
  add_train_command(app);
#endif
}

}  // namespace tumblesight::sim
