#include "hal/dds/handshake.hpp"

#include <unistd.h>

#include "hal/dds/idl/wait_limit.hpp"
#include "hal/dds/stop_request.hpp"

namespace tumblesight::hal::dds {
namespace {

constexpr std::int64_t kPoll_ns = 5'000'000;
constexpr std::int64_t kRefusalTimeout_ns = 2'000'000'000;

// Time for the simulator to take a hello that it has received: it does not see those of programs that have
// left.
constexpr unsigned kRefusalPause_us = 100'000;

// Run id 0 means "present, not ready". The hello names everything that must agree, so that the simulator can
// refuse too.
HelloSample hello_of(const HandshakeSettings& settings, std::uint32_t run_id) {
  HelloSample hello{};
  hello.role = static_cast<std::uint8_t>(Role::kFlight);
  hello.icd_hash = settings.icd_hash;
  hello.run_id = run_id;
  hello.process_id = static_cast<std::uint32_t>(getpid());
  hello.flight_mode = settings.mode;
  hello.command_counter = settings.command_counter;
  hello.model_crc32 = settings.model_crc32;
  set_target(hello, settings.target);
  return hello;
}

bool announce(FlightEndpoints& endpoints, const HandshakeSettings& settings, std::uint32_t run_id) {
  return endpoints.hello_out.write(hello_of(settings, run_id)) == 0;
}

// Waits until the simulator has received our hello, so that it can report the difference too.
void wait_until_hello_is_read(FlightEndpoints& endpoints, const PeerKey& simulator, Stopwatch& stopwatch) {
  const std::uint64_t begin_ns = stopwatch.now_ns();
  while (!endpoints.hello_out.has_reader_of(simulator) && stopwatch.now_ns() - begin_ns < kRefusalTimeout_ns)
    usleep(10'000);
  (void)wait_for_acknowledgment(endpoints.hello_out.entity(), kRefusalTimeout_ns);
  usleep(kRefusalPause_us);
}

FlightEnd end_of(HelloFit fit) {
  if (fit == HelloFit::kFits) return FlightEnd::kComplete;
  return fit == HelloFit::kOtherInterface ? FlightEnd::kIcdUnequal : FlightEnd::kOtherSubject;
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
      const bool second = hello.role == static_cast<std::uint8_t>(Role::kFlight);
      result.end = second ? FlightEnd::kSecondFlight : FlightEnd::kForeign;
      result.foreigner = endpoints.hello_in.describe(from);
      continue;
    }
    result.simulator = from;
    result.run_id = hello.run_id;
    result.hello = hello;
    return true;
  }
  return false;
}

// Whether the wait for the simulator's hello is over for another reason; the result names it.
bool ends_without_hello(const FlightEndpoints& endpoints, bool late, HandshakeResult& result) {
  // The hello of another release can be of another type. It never arrives then, but DDS reports the
  // mismatch.
  const Mismatch mismatch = endpoints.hello_in.latest_mismatch();
  result.saw_other_run |= mismatch == Mismatch::kPartition;
  if (mismatch == Mismatch::kInterface) {
    result.end = FlightEnd::kIcdUnequal;
    return true;
  }
  if (!result.foreigner) {
    result.foreigner = endpoints.foreigner();
    if (result.foreigner) result.end = FlightEnd::kForeign;
  }
  if (result.foreigner) return true;
  if (stop_requested()) {
    result.stopped = true;
    return true;
  }
  if (late) result.end = FlightEnd::kSilence;
  return late;
}

}  // namespace

HandshakeResult shake_hands(FlightEndpoints& endpoints, const HandshakeSettings& settings,
                            Stopwatch& stopwatch) {
  HandshakeResult result;
  result.run_id = settings.run_id;
  endpoints.life.show(endpoints.domain(), hello_of(settings, 0));
  if (!announce(endpoints, settings, 0)) {
    result.end = FlightEnd::kTransport;
    return result;
  }
  bool met = false;
  WaitLimit limit(stopwatch.now_ns(), static_cast<std::uint64_t>(settings.timeout_ns));
  while (!met || !endpoints.bind(result.simulator)) {
    if (!met) {
      met = meet(endpoints, settings.run_id, result);
      if (met) endpoints.life.watch(endpoints.domain(), result.hello);
    }
    if (met) result.fit = fit(hello_of(settings, 0), result.hello);
    if (result.fit != HelloFit::kFits) {
      wait_until_hello_is_read(endpoints, result.simulator, stopwatch);
      result.end = end_of(result.fit);
      return result;
    }
    if (met && (!endpoints.hello_in.bind(result.simulator) || endpoints.life.peer_ended())) {
      result.end = FlightEnd::kSimulatorGone;
      return result;
    }
    if (ends_without_hello(endpoints, limit.is_over(stopwatch.now_ns()), result)) return result;
    usleep(kPoll_ns / 1000);
  }
  if (!announce(endpoints, settings, result.run_id)) result.end = FlightEnd::kTransport;
  return result;
}

}  // namespace tumblesight::hal::dds
