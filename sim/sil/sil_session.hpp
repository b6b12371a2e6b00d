// SilSession: a running flight program and the conversation with it, from the handshake to the last step.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "hal/dds/idl/domain.hpp"
#include "hal/messages/command_packet.hpp"
#include "hal/messages/mode.hpp"
#include "sim/sil/answer_collector.hpp"
#include "sim/sil/domain_lease.hpp"
#include "sim/sil/failure.hpp"
#include "sim/sil/flight_process.hpp"
#include "sim/sil/sil_run.hpp"
#include "sim/sil/simulator_endpoints.hpp"
#include "sim/sil/telecommand.hpp"

namespace tumblesight::sim {

// What the simulator sends for one step. Frames carry their own exposure time and sequence number.
struct StepInput {
  std::int64_t time_ns = 0;
  std::vector<const gnc::RangeImage*> frames;
  std::vector<Telecommand> commands;
  std::vector<hal::CommandPacket> packets;  // behind these, as they are: what no ground would send
  bool last = false;
};

// All of it throws SilFailure when the run cannot go on.
class SilSession {
 public:
  using Clock = std::chrono::steady_clock;

  // Takes a domain, starts flight and returns once both sides are ready.
  explicit SilSession(const SilSettings& settings);

  // Lockstep: one step and its answer. Steps are counted from 0.
  StepAnswer step(const StepInput& input);
  // The two halves. After a step that was the `last`, no other may follow.
  void send(const StepInput& input);
  StepAnswer wait_for_answer(std::uint32_t k);
  // Any answer that comes before `deadline`; free-running flight answers once a cycle, asked or not. Nothing
  // too once flight has ended after the last step, as it should.
  std::optional<StepAnswer> next_answer(Clock::time_point deadline);
  // Sleeps, but not past the end of the flight program.
  void sleep_until(Clock::time_point time);
  // After the last step: flight ends by itself.
  void finish();

  void publish_truth(std::uint32_t sequence, std::uint32_t frame, const FrameTruth& truth,
                     std::int64_t time_ns);
  hal::Mode flight_mode() const { return flight_mode_; }  // that flight announced
  pid_t flight_pid() const { return process_ ? process_->pid() : 0; }
  std::uint32_t run_id() const { return run_id_; }
  std::uint32_t domain() const { return lease_.domain(); }

 private:
  void start_flight();
  void shake_hands();
  bool read_hello();
  bool flight_ended();
  bool flight_ended_as_it_should();
  [[noreturn]] void fail_flight_ended() const;
  std::vector<std::string> flight_command_line() const;
  [[noreturn]] void fail(const std::string& what) const;

  SilSettings settings_;
  DomainLease lease_;
  std::uint32_t run_id_;
  hal::dds::Domain domain_;
  std::unique_ptr<SimulatorEndpoints> endpoints_;
  std::unique_ptr<AnswerCollector> answers_;
  std::unique_ptr<FlightProcess> process_;  // ends before the domain is given back
  TelecommandEncoder encoder_;
  hal::dds::LidarFrameSample frame_sample_{};
  std::uint32_t next_k_ = 0;
  bool last_sent_ = false;
  hal::Mode flight_mode_ = hal::Mode::kBoot;
};

}  // namespace tumblesight::sim
