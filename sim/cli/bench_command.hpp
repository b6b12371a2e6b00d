// tumblesight bench: the speed of the flight network in both numerics with every instruction set, and of
// other runtimes.
#pragma once

#include <CLI/CLI.hpp>

namespace tumblesight::sim {

void add_bench_command(CLI::App& app);

}  // namespace tumblesight::sim
