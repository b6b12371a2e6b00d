// The arguments of `tumblesight simulate`, and the default name of its report.
#pragma once

#include <string>

#include "sim/cli/arguments.hpp"
#include "sim/cli/flight_arguments.hpp"

namespace tumblesight::sim {

struct SimulateArguments : FlightArguments {
  ScenarioArguments scenario;
  std::vector<std::uint32_t> only;  // indices of sequences, in place of the first ones; empty: these
};

// A file name that differs between different runs: target, condition and seed, then every option that is not
// at its default, for example "near_shoemaker_degraded_seed7_100x10_speed2.html". Files appear with their
// stem, followed by one CRC-32 of their full paths. A name that is too long is cut and ends in the CRC-32 of
// the full name.
std::string default_report_name(const SimulateArguments& arguments);

}  // namespace tumblesight::sim
