// The arguments of `tumblesight simulate`, and the name that they give to its report.
#pragma once

#include <string>

#include "sim/cli/arguments.hpp"

namespace tumblesight::sim {

struct SimulateArguments {
  ScenarioArguments scenario;
  std::string speed = "max";
  bool free_running = false;
  std::string flight;       // empty: beside this program; "none": running already
  std::string command_key;  // file; empty: the key that everybody knows
  int domain = -1;          // -1: none given
  std::string report;       // empty: default_report_name() in out/ of the source tree
  std::string command_line;
};

// A file name that tells runs apart: target, condition and seed, then every option that is not at its
// default, for instance "near_shoemaker_degraded_seed7_100x10_speed2.html". Files stand in it with their
// stem, and all of them with a CRC-32 of their full paths; a name that gets too long is cut, with a CRC-32 of
// all of it.
std::string default_report_name(const SimulateArguments& arguments);

}  // namespace tumblesight::sim
