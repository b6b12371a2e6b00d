// `tumblesight export`: a float32 model image as ONNX models, for other runtimes.
#pragma once

#include <CLI/CLI.hpp>

namespace tumblesight::sim {

void add_export_command(CLI::App& app);

}  // namespace tumblesight::sim
