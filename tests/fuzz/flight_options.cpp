// Command lines of the flight program on a desktop.
#include "fsw/programs/desktop/flight_options.hpp"

#include <cstring>

#include "hal/dds/idl/domain.hpp"
#include "tests/fuzz/arguments.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  using namespace tumblesight::fuzz;
  CommandLine line(Input(data, size));
  fsw::desktop::FlightOptions options;
  if (fsw::desktop::parse_flight_options(line.argc(), line.argv(), options) !=
      fsw::desktop::ParseResult::kRun)
    return 0;
  require(options.domain <= hal::dds::kMaxDomain, "a domain is valid in DDS");
  require(options.period_ms >= 1.0 && options.period_ms <= 60'000.0, "a period is within its limits");
  require(options.timeout_s >= 0.1 && options.timeout_s <= 86'400.0, "a timeout is within its limits");
  require(options.target[0] != '\0', "there is a target");
  require(std::memchr(options.model_path, '\0', sizeof options.model_path) != nullptr,
          "a path is NUL-terminated");
  return 0;
}
