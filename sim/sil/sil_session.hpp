// SilSession: a running flight program and the exchange with it, from the handshake to the last step.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/dds/idl/domain.hpp"
#include "hal/dds/idl/hello.hpp"
#include "hal/dds/idl/peer_life.hpp"
#include "hal/dds/idl/run_secret.hpp"
#include "hal/messages/mode.hpp"
#include "sim/operations/signed_telecommand.hpp"
#include "sim/recording/run_step.hpp"
#include "sim/sil/answer_check.hpp"
#include "sim/sil/answer_collector.hpp"
#include "sim/sil/domain_lease.hpp"
#include "sim/sil/failure.hpp"
#include "sim/sil/flight_process.hpp"
#include "sim/sil/run_announcement.hpp"
#include "sim/sil/run_recorder.hpp"
#include "sim/sil/sil_run.hpp"
#include "sim/sil/simulator_endpoints.hpp"

namespace tumblesight::sim {

// Every function throws SilFailure when the run cannot continue.
class SilSession {
 public:
  using Clock = std::chrono::steady_clock;

  // Reserves a domain, starts the flight program, and returns when both sides are ready.
  explicit SilSession(const SilSettings& settings);

  // Lockstep: sends one step and waits for its answer. Steps count from 0.
  StepAnswer step(const StepInput& input);
  // The two halves of step(). No step may follow the `last`.
  void send(const StepInput& input);
  StepAnswer wait_for_answer(std::uint32_t k);
  // The next answer before `deadline`, of any step: a free-running flight program answers once per cycle.
  // Nothing if there was none, or if flight has ended after the last step.
  std::optional<StepAnswer> next_answer(Clock::time_point deadline);
  // Sleeps until `time`, or throws as soon as the flight program ends.
  void sleep_until(Clock::time_point time);
  // After the last step: waits until the flight program ends, which it does by itself.
  void finish();

  // `time_ns`: of the step, `exposure_time_ns`: of the frame that its sensor took.
  void publish_truth(std::uint32_t sequence, std::uint32_t frame, const FrameTruth& truth,
                     std::int64_t time_ns, std::int64_t exposure_time_ns);
  hal::Mode flight_mode() const { return flight_mode_; }  // in the hello of flight
  pid_t flight_pid() const { return process_ ? process_->pid() : 0; }
  std::uint32_t run_id() const { return secret_.run_id; }
  std::uint32_t domain() const { return lease_.domain(); }

 private:
  void open_domain(const char* security);
  hal::dds::HelloSample hello() const;
  void start_flight();
  void shake_hands();
  void read_hello();
  [[noreturn]] void fail_without_hello() const;
  std::string difference_to(const hal::dds::HelloSample& flight) const;
  void wait_for_refusal_of(const hal::dds::PeerKey& flight);
  void bind(const hal::dds::HelloSample& hello, const hal::dds::PeerKey& from);
  void require_no_foreigner();
  std::optional<StepAnswer> collect_answer();
  bool flight_ended();
  bool flight_ended_after_last_step();
  [[noreturn]] void fail_flight_ended() const;
  std::vector<std::string> flight_command_line() const;
  [[noreturn]] void fail(const std::string& what) const;

  SilSettings settings_;
  DomainLease lease_;
  hal::dds::RunSecret secret_;
  hal::dds::Domain domain_;
  std::unique_ptr<SimulatorEndpoints> endpoints_;
  std::unique_ptr<AnswerCollector> answers_;
  hal::dds::PeerLife life_;  // of a flight program that is not our child process
  std::unique_ptr<RunAnnouncement> announcement_;
  std::unique_ptr<RunRecorder> recorder_;  // none: the run is not recorded
  AnswerCheck check_;
  std::unique_ptr<FlightProcess> process_;  // destroyed before the domain is released
  TelecommandEncoder encoder_;
  hal::dds::LidarFrameSample frame_sample_{};
  std::uint32_t next_k_ = 0;
  bool last_sent_ = false;
  std::optional<hal::dds::PeerKey> flight_;  // of the first hello
  bool flight_ready_ = false;                // it has found this run
  bool other_run_seen_ = false;              // in the domain, in another partition
  hal::Mode flight_mode_ = hal::Mode::kBoot;
};

}  // namespace tumblesight::sim
