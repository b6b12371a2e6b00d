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
#include "hal/posix/file_persistent_store.hpp"
#include "hal/posix/monotonic_stopwatch.hpp"
#include "hal/posix/painted_stack.hpp"

namespace {

using namespace tumblesight;
using namespace tumblesight::fsw::desktop;
using hal::dds::FlightEnd;

// All of the flight side's memory.
hal::posix::MonotonicStopwatch stopwatch;
hal::dds::Domain domain;
hal::dds::FlightEndpoints endpoints;
hal::dds::DdsLidar lidar;
hal::posix::PaintedStack stack;
hal::dds::DdsLink link{{heap_allocations, [] { return stack.least_left_bytes(); }}};
hal::dds::FlightBus bus{endpoints, lidar, link, stopwatch};
fsw::AttitudeInitApp app;
hal::CommandKeys command_keys;
hal::posix::FilePersistentStore stored_state;
fsw::CycleWorkspace workspace;
FlightTask task{lidar, link, workspace, stack};

hal::Platform platform_of(const FlightOptions& options) {
  hal::Platform platform;
  platform.stopwatch = &stopwatch;
  platform.command_keys = &command_keys;
  if (options.state_path[0] == '\0') return platform;
  stored_state.use(options.state_path);
  platform.persistent = &stored_state;
  platform.reset_cause = options.reset_cause;
  return platform;
}

// From now on the bus thread queues authentic commands only.
void authenticate_commands() {
  link.authenticate_with(command_keys, app.key_slot(), app.command_counter());
}

FlightEnd connect(const FlightOptions& options) {
  dds_return_t result = domain.open(options.domain);
  if (result == 0) result = endpoints.open(domain.participant());
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
  if (met.end != FlightEnd::kComplete || met.stopped) return met.end;

  bus.join_run(met.run_id, timeout_ns);
  if (!options.free_running) return exchange_in_lockstep(bus, task);
  return exchange_free_running(bus, task, stopwatch, static_cast<std::int64_t>(options.period_ms * 1e6));
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
  if (!read_command_key(options.command_key_path, command_keys.slots[0]))
    return static_cast<int>(FlightEnd::kBadArguments);
  boot(options, app, platform_of(options), argv);
  authenticate_commands();

  const FlightEnd end = fly(options);
  task.join();  // no effect after a run
  if (end != FlightEnd::kComplete) std::fprintf(stderr, "flight: %s\n", hal::dds::to_string(end));
  domain.close();
  return static_cast<int>(end);
}
