// The desktop flight program: the flight application on a Linux machine, with DDS as its sensor and radio
// link.
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "fsw/programs/desktop/flight_key.hpp"
#include "fsw/programs/desktop/flight_loop.hpp"
#include "fsw/programs/desktop/flight_model.hpp"
#include "fsw/programs/desktop/flight_options.hpp"
#include "fsw/programs/desktop/flight_program.hpp"
#include "fsw/programs/desktop/flight_state.hpp"
#include "fsw/programs/desktop/heap_trap.hpp"
#include "hal/dds/handshake.hpp"
#include "hal/dds/idl/domain.hpp"
#include "hal/dds/packet_output.hpp"
#include "hal/dds/stop_request.hpp"
#include "hal/posix/file_persistent_store.hpp"
#include "hal/posix/monitored_stack.hpp"
#include "hal/posix/monotonic_stopwatch.hpp"
#include "hal/posix/packet_file.hpp"

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
hal::posix::MonitoredStack stack;
hal::dds::DdsLink link{{heap_allocations, [] { return stack.least_left_bytes(); }}};
hal::dds::FlightBus bus{endpoints, lidar, navigation, link, stopwatch};
hal::posix::PacketFile packet_file;
hal::dds::PacketOutput packet_output{packet_file};
fsw::AttitudeInitApp app;
hal::CommandKeys command_keys;
hal::posix::FilePersistentStore stored_state;
fsw::CycleWorkspace workspace;
FlightTask task{lidar, navigation, link, stopwatch, workspace, stack};
hal::dds::Foreigner foreigner;  // who ended the run

hal::Platform platform_of(const FlightOptions& options, hal::ModelStore& models) {
  hal::Platform platform;
  platform.stopwatch = &stopwatch;
  platform.models = &models;
  platform.command_keys = &command_keys;
  platform.reset_cause = options.reset_cause;
  if (options.state_path[0] != '\0') platform.persistent = &stored_state;
  return platform;
}

// From now on the bus thread queues authentic commands only.
void authenticate_commands() {
  link.authenticate_with(command_keys, app.key_slot(), app.command_counter());
}

// False: the file for the packets cannot be written.
bool open_packets(const char* path) {
  if (path[0] == '\0') return true;
  const int error = packet_file.open(path);
  if (error != 0) {
    const char* reason = strerrordesc_np(error);
    if (error == EEXIST)
      reason = "the file holds something other than telemetry packets; give another path, or delete it";
    if (error == ENXIO) reason = "nobody reads this pipe; start its reader first, or give a file";
    std::fprintf(stderr, "%s: --packets %s: %s\n", kProgramName, path, reason);
    return false;
  }
  bus.copy_to(packet_output);
  return true;
}

// A run whose packets are not all in the file is not complete.
FlightEnd report_packets(const FlightOptions& options, FlightEnd end) {
  packet_file.close();
  if (packet_file.lost() == 0) return end;
  std::fprintf(stderr, "%s: %u packets could not be written to %s: %s\n", kProgramName, packet_file.lost(),
               options.packets_path, strerrordesc_np(packet_file.error()));
  return end == FlightEnd::kComplete ? FlightEnd::kPacketsLost : end;
}

FlightEnd connect(const FlightOptions& options) {
  if (options.security_path[0] != '\0' && !hal::dds::read_security(options.security_path, security)) {
    std::fprintf(stderr, "%s: --dds-security %s: cannot be read, is empty, or has %zu bytes or more\n",
                 kProgramName, options.security_path, sizeof security.text);
    return FlightEnd::kBadArguments;
  }
  dds_return_t result = domain.open(options.domain, options.partition, security.text);
  if (result == 0) result = endpoints.open(domain);
  if (result == 0) return FlightEnd::kComplete;
  std::fprintf(stderr, "%s: DDS domain %u: %s\n", kProgramName, options.domain,
               hal::dds::text_of_failure(result));
  return FlightEnd::kTransport;
}

void report_difference(const FlightOptions& options, const hal::dds::HandshakeResult& met) {
  const std::uint32_t model_crc32 = app.estimator().model().crc32;
  switch (met.fit) {
    case hal::dds::HelloFit::kFits:
      break;
    case hal::dds::HelloFit::kOtherInterface:
      std::fprintf(stderr,
                   "%s: interface hash %08x differs from the simulator's %08x: build both from the same "
                   "tumblesight.idl\n",
                   kProgramName, options.icd_hash, met.hello.icd_hash);
      break;
    case hal::dds::HelloFit::kOtherTarget:
      std::fprintf(stderr, "%s: target %s differs from the simulator's %s: give both the same --target\n",
                   kProgramName, options.target, hal::dds::target_of(met.hello).text);
      break;
    case hal::dds::HelloFit::kOtherModel:
      std::fprintf(stderr,
                   "%s: model image %s (CRC-32 %08x) differs from the simulator's (CRC-32 %08x): give both "
                   "the same --model; without it each takes the image that ships for the target\n",
                   kProgramName, options.model_path, model_crc32, met.hello.model_crc32);
      break;
  }
}

hal::dds::HandshakeResult meet_simulator(const FlightOptions& options, std::int64_t timeout_ns) {
  hal::dds::HandshakeSettings settings;
  settings.icd_hash = options.icd_hash;
  settings.run_id = options.run_id;
  settings.mode = static_cast<std::uint8_t>(app.mode());
  settings.command_counter = app.command_counter();
  settings.target = options.target;
  settings.model_crc32 = app.estimator().model().crc32;
  settings.timeout_ns = timeout_ns;
  const hal::dds::HandshakeResult met = hal::dds::shake_hands(endpoints, settings, stopwatch);
  report_difference(options, met);
  if (met.end == FlightEnd::kSilence && met.saw_other_run)
    std::fprintf(
        stderr,
        "%s: note: another run is in DDS domain %u, with a flight program of its own; give this program "
        "and its simulator another --domain\n",
        kProgramName, options.domain);
  return met;
}

FlightEnd fly(const FlightOptions& options) {
  if (!task.start(app, options.free_running)) return FlightEnd::kNoThread;
  const FlightEnd connected = connect(options);
  if (connected != FlightEnd::kComplete) return connected;
  const auto timeout_ns = static_cast<std::int64_t>(options.timeout_s * 1e9);
  const hal::dds::HandshakeResult met = meet_simulator(options, timeout_ns);
  foreigner = met.foreigner;
  if (met.stopped) return hal::dds::stop_reason();
  if (met.end != FlightEnd::kComplete) return met.end;

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
      return print_flight_help() ? EXIT_SUCCESS : EXIT_FAILURE;
    case ParseResult::kVersion:
      return print_flight_version() ? EXIT_SUCCESS : EXIT_FAILURE;
    case ParseResult::kError:
      return static_cast<int>(FlightEnd::kBadArguments);
    case ParseResult::kRun:
      break;
  }
  hal::posix::FileModelStore& model = open_model(options);
  if (!kFlyFloat32 && wants_float32(options, model)) return static_cast<int>(become_float32_program(argv));
  hal::dds::accept_stop_requests();
  if (!read_command_key(options.command_key_path, command_keys.slots[0]))
    return static_cast<int>(FlightEnd::kBadArguments);
  const bool with_state = options.state_path[0] != '\0';
  if (with_state && !open_state(options, stored_state)) return static_cast<int>(FlightEnd::kBadArguments);
  if (!open_packets(options.packets_path)) return static_cast<int>(FlightEnd::kBadArguments);
  boot(options, app, platform_of(options, model), model);
  if (with_state) report_state(options, app);
  authenticate_commands();

  FlightEnd end = fly(options);
  task.join();  // no effect after a run
  end = report_packets(options, end);
  if (end == FlightEnd::kForeign || end == FlightEnd::kSecondFlight) {
    std::fprintf(stderr, "%s: %s: %s; give each run a DDS domain of its own with --domain (here %u)\n",
                 kProgramName, hal::dds::to_string(end), to_text(foreigner).text, options.domain);
  } else if (end != FlightEnd::kComplete && end != FlightEnd::kPacketsLost &&
             end != FlightEnd::kBadArguments) {
    std::fprintf(stderr, "%s: %s\n", kProgramName, hal::dds::to_string(end));
  }
  domain.close();
  return static_cast<int>(end);
}
