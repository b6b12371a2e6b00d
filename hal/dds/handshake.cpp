#include "hal/dds/handshake.hpp"

#include <unistd.h>

#include "hal/dds/stop_request.hpp"

namespace tumblesight::hal::dds {
namespace {

constexpr std::int64_t kPoll_ns = 5'000'000;
constexpr std::int64_t kFarewell_ns = 2'000'000'000;

// Run id 0 says "here, but not ready": it carries the hash, so that the simulator can refuse as well.
bool announce(FlightEndpoints& endpoints, const HandshakeSettings& settings, std::uint32_t run_id) {
  HelloSample hello{};
  hello.role = static_cast<std::uint8_t>(Role::kFlight);
  hello.icd_hash = settings.icd_hash;
  hello.run_id = run_id;
  hello.process_id = static_cast<std::uint32_t>(getpid());
  hello.flight_mode = settings.mode;
  return endpoints.hello_out.write(hello) == 0;
}

// The simulator has to learn of the unequal hash before this process ends.
void let_simulator_read_hello(FlightEndpoints& endpoints, Stopwatch& stopwatch) {
  const std::uint64_t begin_ns = stopwatch.now_ns();
  while (endpoints.hello_out.matched() == 0 && stopwatch.now_ns() - begin_ns < kFarewell_ns) usleep(10'000);
  (void)wait_for_acknowledgment(endpoints.hello_out.entity(), kFarewell_ns);
}

bool meant_for_us(const HelloSample& hello, std::uint32_t run_id) {
  return hello.role == static_cast<std::uint8_t>(Role::kSimulator) && (run_id == 0 || hello.run_id == run_id);
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
  while (!met || !endpoints.all_matched()) {
    HelloSample hello;
    while (!met && endpoints.hello_in.take(hello)) {
      if (!meant_for_us(hello, settings.run_id)) continue;
      met = true;
      result.run_id = hello.run_id;
      result.simulator_icd_hash = hello.icd_hash;
    }
    if (met && result.simulator_icd_hash != settings.icd_hash) {
      let_simulator_read_hello(endpoints, stopwatch);
      result.end = FlightEnd::kIcdUnequal;
      return result;
    }
    // Another release's Hello may be of another type: then it never arrives, but the mismatch shows.
    if (endpoints.hello_in.saw_incompatible()) {
      result.end = FlightEnd::kIcdUnequal;
      return result;
    }
    if (met && endpoints.hello_in.matched() == 0) {
      result.end = FlightEnd::kSimulatorGone;
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
