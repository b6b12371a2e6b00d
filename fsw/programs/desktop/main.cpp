// The desktop flight program: the flight application on a Linux machine, with DDS as its sensor and radio
// link.
#include <cstdio>
#include <cstdlib>

#include "fsw/programs/desktop/flight_key.hpp"
#include "fsw/programs/desktop/flight_loop.hpp"
#include "fsw/programs/desktop/flight_model.hpp"
#include "fsw/programs/desktop/flight_options.hpp"
#include "fsw/programs/desktop/heap_trap.hpp"
#include "hal/dds/handshake.hpp"
#include "hal/dds/idl/domain.hpp"
#include "hal/dds/stop_request.hpp"
#include "hal/posix/monotonic_stopwatch.hpp"
#include "hal/posix/painted_stack.hpp"

namespace {

using namespace tumblesight;
using namespace tumblesight::fsw::desktop;
using hal::dds::FlightEnd;

// All of the flight side's memory.
hal::posix::MonotonicStopwatch stopwatch;
hal::dds::SecurityElement security;
hal::dds::Domain domain;
hal::dds::FlightEndpoints endpoints;
hal::dds::DdsLidar lidar;
hal::dds::DdsNavigation navigation;
hal::posix::PaintedStack stack;
hal::dds::DdsLink link{{heap_allocations, [] { return stack.least_left_bytes(); }}};
hal::dds::FlightBus bus{endpoints, lidar, navigation, link, stopwatch};
fsw::AttitudeInitApp app;
hal::CommandKey command_key;
fsw::CycleWorkspace workspace;
FlightTask task{lidar, navigation, link, workspace, stack};
hal::dds::Foreigner foreigner;  // who ended the run

FlightEnd connect(const FlightOptions& options) {
  if (options.security_path[0] != '\0' && !hal::dds::read_security(options.security_path, security)) {
    std::fprintf(stderr, "flight: --dds-security %s: cannot be read, or is too large\n",
                 options.security_path);
    return FlightEnd::kBadArguments;
  }
  dds_return_t result = domain.open(options.domain, options.partition, security.text);
  if (result == 0) result = endpoints.open(domain);
  if (result == 0) return FlightEnd::kComplete;
  std::fprintf(stderr, "flight: DDS domain %u: %s\n", options.domain, dds_strretcode(result));
  return FlightEnd::kTransport;
}

hal::dds::HandshakeResult meet_simulator(const FlightOptions& options, std::int64_t timeout_ns) {
  hal::dds::HandshakeSettings settings;
  settings.icd_hash = options.icd_hash;
  settings.run_id = options.run_id;
  settings.mode = static_cast<std::uint8_t>(app.mode());
  settings.timeout_ns = timeout_ns;
  const hal::dds::HandshakeResult met = hal::dds::shake_hands(endpoints, settings, stopwatch);
  if (met.end == FlightEnd::kIcdUnequal) {
    std::fprintf(stderr,
                 "flight: interface hash %08x differs from the simulator's %08x: build both from the same "
                 "tumblesight.idl\n",
                 options.icd_hash, met.simulator_icd_hash);
  }
  return met;
}

FlightEnd fly(const FlightOptions& options) {
  if (!task.start(app, options.free_running)) return FlightEnd::kNoThread;
  const FlightEnd connected = connect(options);
  if (connected != FlightEnd::kComplete) return connected;
  const auto timeout_ns = static_cast<std::int64_t>(options.timeout_s * 1e9);
  const hal::dds::HandshakeResult met = meet_simulator(options, timeout_ns);
  foreigner = met.foreigner;
  if (met.end != FlightEnd::kComplete || met.stopped) return met.end;

  bus.join_run(met.run_id, timeout_ns);
  const FlightEnd end =
      options.free_running
          ? exchange_free_running(bus, task, stopwatch, static_cast<std::int64_t>(options.period_ms * 1e6))
          : exchange_in_lockstep(bus, task);
  foreigner = bus.foreigner();
  return end;
}

}  // namespace

int main(int argc, char** argv) {
  FlightOptions options;
  switch (parse_flight_options(argc, argv, options)) {
    case ParseResult::kHelp:
      print_flight_help();
      return EXIT_SUCCESS;
    case ParseResult::kVersion:
      print_flight_version();
      return EXIT_SUCCESS;
    case ParseResult::kError:
      return static_cast<int>(FlightEnd::kBadArguments);
    case ParseResult::kRun:
      break;
  }
  hal::dds::accept_stop_requests();
  if (!read_command_key(options.command_key_path, command_key))
    return static_cast<int>(FlightEnd::kBadArguments);
  boot(options, app, stopwatch, command_key, argv);

  const FlightEnd end = fly(options);
  task.join();  // no effect after a run
  if (end == FlightEnd::kForeign) {
    std::fprintf(stderr, "flight: %s: %s\n", hal::dds::to_string(end), to_text(foreigner).text);
  } else if (end != FlightEnd::kComplete) {
    std::fprintf(stderr, "flight: %s\n", hal::dds::to_string(end));
  }
  domain.close();
  return static_cast<int>(end);
}
