// RequestLine: a request from another program of the user to a running simulation, as a line of JSON. The run
// parses it with read_request_line(). The program that asks calls the same function first, to report what is
// wrong before it sends anything. `run_control.hpp` lists the requests.
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

// Throws std::invalid_argument that names the value that no run accepts.
RequestLine read_request_line(const std::string& line);

}  // namespace tumblesight::sim
