#include "hal/dds/handshake.hpp"

#include <unistd.h>

#include "hal/dds/stop_request.hpp"

namespace tumblesight::hal::dds {
namespace {

constexpr std::int64_t kPoll_ns = 5'000'000;
constexpr std::int64_t kRefusalTimeout_ns = 2'000'000'000;

// Run id 0 means "present, not ready". The sample carries the hash, so that the simulator can refuse too.
bool announce(FlightEndpoints& endpoints, const HandshakeSettings& settings, std::uint32_t run_id) {
  HelloSample hello{};
  hello.role = static_cast<std::uint8_t>(Role::kFlight);
  hello.icd_hash = settings.icd_hash;
  hello.run_id = run_id;
  hello.process_id = static_cast<std::uint32_t>(getpid());
  hello.flight_mode = settings.mode;
  hello.command_counter = settings.command_counter;
  return endpoints.hello_out.write(hello) == 0;
}

// Waits until the simulator has received the unequal hash, so that it can report it too.
void wait_until_hello_is_read(FlightEndpoints& endpoints, const PeerKey& simulator, Stopwatch& stopwatch) {
  const std::uint64_t begin_ns = stopwatch.now_ns();
  while (!endpoints.hello_out.has_reader_of(simulator) && stopwatch.now_ns() - begin_ns < kRefusalTimeout_ns)
    usleep(10'000);
  (void)wait_for_acknowledgment(endpoints.hello_out.entity(), kRefusalTimeout_ns);
}

// On a bus of our own there is one simulator and no other flight program.
bool is_from_simulator_of(const HelloSample& hello, std::uint32_t run_id) {
  return hello.role == static_cast<std::uint8_t>(Role::kSimulator) && (run_id == 0 || hello.run_id == run_id);
}

// Takes the hellos that have arrived, up to the first one of the simulator.
bool meet(FlightEndpoints& endpoints, std::uint32_t run_id, HandshakeResult& result) {
  HelloSample hello;
  PeerKey from;
  while (!result.foreigner && endpoints.hello_in.take(hello, from)) {
    if (!is_from_simulator_of(hello, run_id)) {
      result.foreigner = endpoints.hello_in.describe(from);
      continue;
    }
    result.simulator = from;
    result.run_id = hello.run_id;
    result.simulator_icd_hash = hello.icd_hash;
    return true;
  }
  return false;
}

}  // namespace

HandshakeResult shake_hands(FlightEndpoints& endpoints, const HandshakeSettings& settings,
                            Stopwatch& stopwatch) {
  HandshakeResult result;
  result.run_id = settings.run_id;
  if (!announce(endpoints, settings, 0)) {
    result.end = FlightEnd::kTransport;
    return result;
  }
  bool met = false;
  const std::uint64_t begin_ns = stopwatch.now_ns();
  while (!met || !endpoints.bind(result.simulator)) {
    if (!met) met = meet(endpoints, settings.run_id, result);
    if (met && result.simulator_icd_hash != settings.icd_hash) {
      wait_until_hello_is_read(endpoints, result.simulator, stopwatch);
      result.end = FlightEnd::kIcdUnequal;
      return result;
    }
    // The hello of another release can be of another type. It never arrives then, but DDS reports the
    // mismatch.
    if (endpoints.hello_in.saw_incompatible()) {
      result.end = FlightEnd::kIcdUnequal;
      return result;
    }
    if (met && !endpoints.hello_in.bind(result.simulator)) {
      result.end = FlightEnd::kSimulatorGone;
      return result;
    }
    if (!result.foreigner) result.foreigner = endpoints.foreigner();
    if (result.foreigner) {
      result.end = FlightEnd::kForeign;
      return result;
    }
    if (stop_requested()) {
      result.stopped = true;
      return result;
    }
    if (stopwatch.now_ns() - begin_ns > static_cast<std::uint64_t>(settings.timeout_ns)) {
      result.end = FlightEnd::kSilence;
      return result;
    }
    usleep(kPoll_ns / 1000);
  }
  if (!announce(endpoints, settings, result.run_id)) result.end = FlightEnd::kTransport;
  return result;
}

}  // namespace tumblesight::hal::dds
