// FlightBus: carries samples between DDS and the flight task's LiDAR and link. It runs on the bus thread
// only: Cyclone DDS allocates from the heap, which the flight task must not do.
#pragma once

#include <cstdint>

#include "hal/dds/dds_lidar.hpp"
#include "hal/dds/dds_link.hpp"
#include "hal/dds/dds_navigation.hpp"
#include "hal/dds/flight_endpoints.hpp"
#include "hal/dds/idl/flight_end.hpp"
#include "hal/dds/idl/step_content.hpp"
#include "hal/dds/idl/wait_limit.hpp"
#include "hal/dds/packet_output.hpp"
#include "hal/stopwatch.hpp"

namespace tumblesight::hal::dds {

class FlightBus {
 public:
  FlightBus(FlightEndpoints& endpoints, DdsLidar& lidar, DdsNavigation& navigation, DdsLink& link,
            Stopwatch& stopwatch)
      : endpoints_(endpoints), lidar_(lidar), navigation_(navigation), link_(link), stopwatch_(stopwatch) {}

  // From now on a sample of another run ends this one, and so does a `timeout_ns` without a step.
  void join_run(std::uint32_t run_id, std::int64_t timeout_ns);
  std::uint32_t run_id() const { return run_id_; }

  // From now on carry_out() also gives everything that it publishes to `packets`.
  void copy_to(PacketOutput& packets) { packets_ = &packets; }

  // Takes the oldest step that has arrived. False: there is none.
  bool take_step(StepSample& step);
  // Lockstep: waits for step `k` and hands its samples to the flight task. DDS does not keep the
  // order across topics, so the step is ready only when all the samples it announces have arrived. They must
  // be those that it announces (StepContent), and no other program may write to the topics. False: step `k`
  // will not arrive; `end` gives the reason.
  [[nodiscard]] bool wait_for_step(std::uint32_t k, StepSample& step, FlightEnd& end);

  // Free-running: hands all samples that have arrived to the flight task, then waits for more, at most
  // `timeout_ns`.
  void carry_in(std::int64_t timeout_ns);
  // Whether the flight task has received the frame of step `k` or of a later one.
  bool has_frame_of(std::uint32_t k) const { return has_frame_ && latest_frame_k_ >= k; }

  // Publishes the output of all cycles that have ended. False if DDS refused a sample.
  [[nodiscard]] bool carry_out();
  // Waits until the simulator has received all published samples, at most 2 s per topic.
  void flush() const;

  // Whether the run must end: stop request, timeout or simulator gone. `end` gives the reason.
  [[nodiscard]] bool must_end(FlightEnd& end);
  // After kForeign: who it is.
  const Foreigner& foreigner() const { return foreigner_; }

 private:
  // Samples of step `k`, or of any step if `content` is nullptr.
  void carry_frames(std::uint32_t k, StepContent* content);
  void carry_navigations(std::uint32_t k, StepContent* content);
  void carry_commands(std::uint32_t k, StepContent* content);
  bool belongs(std::uint32_t run_id, std::uint32_t sample_k, std::uint32_t k, const StepContent* content);
  [[nodiscard]] bool check_writers(FlightEnd& end);
  void heard_something() { silence_ = WaitLimit(stopwatch_.now_ns(), timeout_ns_); }

  FlightEndpoints& endpoints_;
  DdsLidar& lidar_;
  DdsNavigation& navigation_;
  DdsLink& link_;
  Stopwatch& stopwatch_;
  PacketOutput* packets_ = nullptr;
  LidarFrameSample frame_{};
  CycleOutput output_{};
  WaitLimit silence_;
  std::uint64_t timeout_ns_ = 0;
  std::uint32_t run_id_ = 0;
  std::uint32_t latest_frame_k_ = 0;
  bool has_frame_ = false;
  bool out_of_order_ = false;  // a sample of another run or step has arrived
  Foreigner foreigner_{};
};

}  // namespace tumblesight::hal::dds
