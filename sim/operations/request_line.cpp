#include "sim/operations/request_line.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "hal/messages/command_packet.hpp"
#include "sim/host/text.hpp"
#include "sim/json/json_text.hpp"
#include "sim/operations/telecommand_table.hpp"

namespace tumblesight::sim {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostDepth = 4;
constexpr std::uint32_t kMostFunction = 127;

// `what` names it: "steps". As it was given: a number beyond 64 bits is not whole in JSON.
std::uint32_t whole_number(const Json& value, const std::string& what, std::uint32_t least,
                           std::uint32_t most) {
  const bool is_in_range = value.is_number_integer() && value >= Json(least) && value <= Json(most);
  if (is_in_range) return value.get<std::uint32_t>();
  throw std::invalid_argument(fmt::format("{} must be a whole number from {} to {}, not {}", what, least,
                                          most, shortened(value.dump())));
}

InjectedFault fault_of(const Json& request) {
  InjectedFault fault;
  fault.name = request.at("fault").get<std::string>();
  const FaultRow& row = fault_named(fault.name);
  fault.steps = whole_number(request.at("steps"), "fault " + fault.name + ": steps", 1, kMostFaultSteps);
  if (request.contains("strength")) {
    const Json& strength = request.at("strength");
    if (!strength.is_number())
      throw std::invalid_argument("the strength must be a number, not " + shortened(strength.dump()));
    fault.strength = strength.get<double>();
  } else if (has_strength(row)) {
    throw std::invalid_argument("fault " + fault.name + " needs a strength, " + strength_limits(row));
  }
  require_possible(fault);
  return fault;
}

std::vector<std::uint8_t> arguments_of(const std::string& digits) {
  try {
    return bytes_of_hex(digits);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        fmt::format("the arguments must be bytes of two hexadecimal digits each, not '{}': {}",
                    shortened(digits), error.what()));
  }
}

Telecommand telecommand_of(const Json& request) {
  const std::uint32_t function = whole_number(request.at("function"), "the function code", 0, kMostFunction);
  const std::vector<std::uint8_t> arguments = arguments_of(request.at("arguments").get<std::string>());
  if (arguments.size() > hal::kMaxCommandArgumentBytes)
    throw std::invalid_argument(fmt::format("a telecommand has at most {} bytes of arguments, not {}",
                                            hal::kMaxCommandArgumentBytes, arguments.size()));
  return {static_cast<hal::FunctionCode>(function), arguments};
}

}  // namespace

RequestLine read_request_line(const std::string& line) {
  RequestLine read;
  try {
    const Json request = parse_json(line, {kMostDepth});
    if (request.contains("fault"))
      read.fault = fault_of(request);
    else
      read.command = telecommand_of(request);
  } catch (const Json::exception&) {
    throw std::invalid_argument("the request lacks a field, or one is of another type");
  }
  return read;
}

}  // namespace tumblesight::sim
