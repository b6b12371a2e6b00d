// `tumblesight bench`: speed of the flight network in both numerics and with every instruction set, compared
// with other runtimes.
#pragma once

#include <CLI/CLI.hpp>

namespace tumblesight::sim {

void add_bench_command(CLI::App& app);

}  // namespace tumblesight::sim
