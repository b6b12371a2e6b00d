// RequestLine: what another program of the user asks of a run that goes on, as a line of JSON. The run reads
// it with read_request_line(), and so does who asks, in order to say before what is wrong in it.
// `run_control.hpp` has the lines.
#pragma once

#include <optional>
#include <string>

#include "sim/operations/fault_table.hpp"
#include "sim/operations/signed_telecommand.hpp"

namespace tumblesight::sim {

struct RequestLine {
  std::optional<InjectedFault> fault;
  Telecommand command;  // without a fault
};

// Throws std::invalid_argument that says what no run would take, with the value.
RequestLine read_request_line(const std::string& line);

}  // namespace tumblesight::sim
