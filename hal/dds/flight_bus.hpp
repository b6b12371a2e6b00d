// FlightBus: carries samples between DDS and the flight task's LiDAR and link. Runs on the bus thread alone,
// since Cyclone DDS takes from the heap as it likes, which the flight task must not.
#pragma once

#include <cstdint>

#include "hal/dds/dds_lidar.hpp"
#include "hal/dds/dds_link.hpp"
#include "hal/dds/flight_endpoints.hpp"
#include "hal/dds/idl/flight_end.hpp"
#include "hal/stopwatch.hpp"

namespace tumblesight::hal::dds {

class FlightBus {
 public:
  FlightBus(FlightEndpoints& endpoints, DdsLidar& lidar, DdsLink& link, Stopwatch& stopwatch)
      : endpoints_(endpoints), lidar_(lidar), link_(link), stopwatch_(stopwatch) {}

  // From now on samples of other runs are left out; silence for longer than `timeout_ns` ends the run.
  void join_run(std::uint32_t run_id, std::int64_t timeout_ns);
  std::uint32_t run_id() const { return run_id_; }

  // The oldest step announced and not yet taken.
  bool take_step(StepSample& step);
  // Lockstep. DDS gives no order across topics, so a step is ready only once everything that it announces has
  // been handed to the flight task. False: there will be no step `k`, `end` says why.
  [[nodiscard]] bool wait_for_step(std::uint32_t k, StepSample& step, FlightEnd& end);

  // Free-running: hands over whatever has come, and returns once more has or the time is over.
  void carry_in(std::int64_t timeout_ns);
  // Step of the latest frame handed over, and whether there was one.
  bool has_frame_of(std::uint32_t k) const { return has_frame_ && latest_frame_k_ >= k; }

  // Publishes what the flight task has put out. False if DDS refused a sample.
  [[nodiscard]] bool carry_out();
  // Until the simulator has all of it.
  void flush() const;

  // Why the run cannot go on: a stop request, silence, the simulator gone.
  [[nodiscard]] bool must_end(FlightEnd& end) const;

 private:
  int carry_frames(std::uint32_t k, bool any_step);
  int carry_commands(std::uint32_t k, bool any_step);
  void heard_something() { last_heard_ns_ = stopwatch_.now_ns(); }

  FlightEndpoints& endpoints_;
  DdsLidar& lidar_;
  DdsLink& link_;
  Stopwatch& stopwatch_;
  LidarFrameSample frame_{};
  CycleOutput output_{};
  std::uint64_t last_heard_ns_ = 0;
  std::uint64_t timeout_ns_ = 0;
  std::uint32_t run_id_ = 0;
  std::uint32_t latest_frame_k_ = 0;
  bool has_frame_ = false;
};

}  // namespace tumblesight::hal::dds
