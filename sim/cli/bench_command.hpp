// `tumblesight bench`: how fast the flight network is, with every numerics and instruction set, and beside
// other runtimes.
#pragma once

#include <CLI/CLI.hpp>

namespace tumblesight::sim {

void add_bench_command(CLI::App& app);

}  // namespace tumblesight::sim
