#include "fsw/programs/desktop/flight_loop.hpp"

#include <cstdio>

#include "hal/posix/periodic_task.hpp"

namespace tumblesight::hal::dds {
namespace {

constexpr std::int64_t kPoll_ns = 1'000'000;

FlightEnd lockstep_steps(FlightBus& bus, FlightTask& task) {
  for (std::uint32_t k = 0;; ++k) {
    StepSample step;
    FlightEnd end = FlightEnd::kComplete;
    if (!bus.wait_for_step(k, step, end)) return end;
    task.run_cycle(k, step.time_ns);
    if (!bus.carry_out()) return FlightEnd::kTransport;
    if (step.last != 0) return FlightEnd::kComplete;
  }
}

// The simulator's first step tells what time it is.
bool wait_for_first_step(FlightBus& bus, StepSample& step, FlightEnd& end) {
  while (!bus.take_step(step)) {
    if (bus.must_end(end)) return false;
    bus.carry_in(kPoll_ns);
  }
  return true;
}

// Until the last step and its frame are with the flight task.
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

// Once the task has ended: what the last telemetry could not tell any more.
FlightEnd report(const FlightTask& task, FlightEnd end) {
  if (task.slips() > 0)
    std::fprintf(stderr, "flight: %u releases of the flight task slipped\n", task.slips());
  if (task.heap_allocations() > 0) {
    std::fprintf(stderr, "flight: the flight task used the heap %u times, first for %zu bytes\n",
                 task.heap_allocations(), task.first_heap_allocation_bytes());
    if (end == FlightEnd::kComplete) return FlightEnd::kHeapUsed;
  }
  return end;
}

}  // namespace

FlightEnd run_lockstep(FlightBus& bus, FlightTask& task) {
  task.join_run(bus.run_id());
  const FlightEnd end = lockstep_steps(bus, task);
  task.join();
  if (end == FlightEnd::kComplete) bus.flush();
  return report(task, end);
}

FlightEnd run_free(FlightBus& bus, FlightTask& task, Stopwatch& stopwatch, std::int64_t period_ns) {
  StepSample first;
  FlightEnd end = FlightEnd::kComplete;
  if (!wait_for_first_step(bus, first, end)) return end;
  const MissionClock clock{first.time_ns, static_cast<std::int64_t>(stopwatch.now_ns()), period_ns};
  // A quarter of a period after each exposure: the frame is there by then, and one that is a little late
  // still makes it.
  posix::PosixPeriodicTask timer(clock.wall_ns + period_ns / 4, period_ns);
  task.join_run(bus.run_id());
  task.begin_free(timer, clock);
  end = carry_until_last(bus);
  task.join();
  if (end == FlightEnd::kComplete && !bus.carry_out()) end = FlightEnd::kTransport;
  if (end == FlightEnd::kComplete) bus.flush();
  return report(task, end);
}

}  // namespace tumblesight::hal::dds
