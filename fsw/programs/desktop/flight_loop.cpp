#include "fsw/programs/desktop/flight_loop.hpp"

#include <cstdio>

#include "fsw/programs/desktop/flight_program.hpp"
#include "hal/posix/realtime.hpp"

namespace tumblesight::fsw::desktop {
namespace {

using hal::dds::FlightBus;
using hal::dds::FlightEnd;
using hal::dds::StepSample;

constexpr std::int64_t kPoll_ns = 1'000'000;

FlightEnd exchange_steps(FlightBus& bus, FlightTask& task) {
  for (std::uint32_t k = 0;; ++k) {
    StepSample step;
    FlightEnd end = FlightEnd::kComplete;
    if (!bus.wait_for_step(k, step, end)) return end;
    task.request_cycle(k, step.time_ns);
    if (!bus.carry_out()) return FlightEnd::kTransport;
    if (step.last != 0) return FlightEnd::kComplete;
  }
}

// Waits for the simulator's first step, which sets the mission time. False: no step will arrive; `end` gives
// the reason.
bool wait_for_first_step(FlightBus& bus, StepSample& step, FlightEnd& end) {
  while (!bus.take_step(step)) {
    if (bus.must_end(end)) return false;
    bus.carry_in(kPoll_ns);
  }
  return true;
}

// Returns when the flight task has received the last step and its frame.
FlightEnd carry_until_last(FlightBus& bus) {
  StepSample step{};
  for (;;) {
    bus.carry_in(kPoll_ns);
    if (!bus.carry_out()) return FlightEnd::kTransport;
    StepSample newer;
    while (bus.take_step(newer)) step = newer;
    if (step.last != 0 && (step.frames == 0 || bus.has_frame_of(step.k))) return FlightEnd::kComplete;
    FlightEnd end = FlightEnd::kComplete;
    if (bus.must_end(end)) return end;
  }
}

// Reports slips and heap use after the task has ended: too late for telemetry.
FlightEnd report_end(const FlightTask& task, FlightEnd end) {
  if (task.slips() > 0)
    std::fprintf(stderr, "%s: %u releases of the flight task slipped\n", kProgramName, task.slips());
  if (task.heap_allocations() > 0) {
    std::fprintf(stderr, "%s: the flight task used the heap %u times, first for %zu bytes\n", kProgramName,
                 task.heap_allocations(), task.first_heap_allocation_bytes());
    if (end == FlightEnd::kComplete) return FlightEnd::kHeapUsed;
  }
  return end;
}

}  // namespace

FlightEnd exchange_in_lockstep(FlightBus& bus, FlightTask& task) {
  task.set_run_id(bus.run_id());
  const FlightEnd end = exchange_steps(bus, task);
  task.join();
  if (end == FlightEnd::kComplete) bus.flush();
  return report_end(task, end);
}

FlightEnd exchange_free_running(FlightBus& bus, FlightTask& task, hal::Stopwatch& stopwatch,
                                std::int64_t period_ns) {
  StepSample first;
  FlightEnd end = FlightEnd::kComplete;
  if (!wait_for_first_step(bus, first, end)) return end;
  const MissionClock clock{first.time_ns, static_cast<std::int64_t>(stopwatch.now_ns()), period_ns};
  // Cycles start a quarter of a period after each exposure, so that a frame which is slightly late is still
  // used.
  hal::posix::PosixPeriodicTask timer(clock.wall_ns + period_ns / 4, period_ns);
  task.set_run_id(bus.run_id());
  task.start_cycles(timer, clock);
  end = carry_until_last(bus);
  task.join();
  if (end == FlightEnd::kComplete && !bus.carry_out()) end = FlightEnd::kTransport;
  if (end == FlightEnd::kComplete) bus.flush();
  return report_end(task, end);
}

}  // namespace tumblesight::fsw::desktop
