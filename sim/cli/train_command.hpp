// `tumblesight train`: trains a network for a target and writes its model images.
#pragma once

#include <CLI/CLI.hpp>

namespace tumblesight::sim {

void add_train_command(CLI::App& app);

}  // namespace tumblesight::sim
