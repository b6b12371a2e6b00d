// A step of a run as JSON, for the page: a row of numbers for the charts, and all that is known of one step.
#pragma once

#include <nlohmann/json.hpp>

#include "sim/console/step_log.hpp"

namespace tumblesight::sim {

// The names of the numbers of a row, with their units.
Json row_fields();
// In their order; null: not known. `seconds`: since the first step.
Json row_of(const LoggedStep& step, double seconds);
// `seconds`: since the first step.
Json detail_of(const LoggedStep& step, double seconds);
// "SET_MODE 2": the name, and the bytes of the arguments.
std::string text_of(const hal::dds::CommandSample& command);

}  // namespace tumblesight::sim
