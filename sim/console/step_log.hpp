// StepLog: what the console knows of a run: one entry per step, with its events and commands. One thread adds
// the samples of the bus or of a recording; any thread reads. The samples of a step may come in any order
// across topics.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hal/dds/idl/topics.hpp"
#include "hal/messages/attitude_report.hpp"
#include "hal/messages/event.hpp"
#include "hal/messages/telemetry.hpp"

namespace tumblesight::sim {

using Json = nlohmann::ordered_json;

struct LoggedStep {
  std::uint32_t k = 0;
  std::int64_t time_ns = 0;
  std::uint32_t frames = 0;  // that were sent for it
  std::optional<hal::dds::TruthSample> truth;
  // At the exposure of the frame that the attitude is from, which need not be one of this step. Nothing:
  // there is no attitude, or the truth at its exposure is not known.
  std::optional<hal::dds::TruthSample> truth_of_attitude;
  std::optional<hal::AttitudeReport> attitude;
  std::optional<hal::Telemetry> telemetry;
};

class StepLog {
 public:
  static constexpr std::size_t kMostSteps = 200'000;  // older ones are dropped; 0.4 GB
  static constexpr std::size_t kRowsPerAnswer = 20'000;

  // A hello of the simulator begins a run if its run id is another one: what is known of the one before is
  // dropped. Samples of other runs are ignored.
  void add(const hal::dds::HelloSample& hello);
  void add(const hal::dds::TruthSample& sample);
  void add(const hal::dds::StepSample& sample);
  void add(const hal::dds::LidarFrameSample& sample);
  void add(const hal::dds::CommandSample& sample);
  void add(const hal::dds::AttitudeSample& sample);
  void add(const hal::dds::TelemetrySample& sample);
  void add(const hal::dds::EventSample& sample);
  void add(const hal::dds::StepDoneSample& sample);
  // Before the first sample: no flight program answers, so that a step is complete without an answer.
  void expect_no_answers() { expects_answers_ = false; }
  // No sample follows: steps that wait for more are shown as they are.
  void end();

  // The state in short. Changes whenever there is something new.
  struct State {
    std::uint32_t run_id = 0;
    std::uint64_t steps = 0;  // number of the newest one plus 1
    bool has_ended = false;
    bool operator==(const State& other) const {
      return run_id == other.run_id && steps == other.steps && has_ended == other.has_ended;
    }
  };
  State state() const;
  std::string target() const;  // empty: not known yet
  // A late console numbers the steps that it has seen from 0 on, whatever their k is. Rows and details have
  // both.
  std::int64_t k_of(std::uint64_t number) const;        // -1: there is no such step
  std::int64_t time_ns_of(std::uint64_t number) const;  // -1: the same
  std::uint64_t number_of(std::uint32_t k) const;       // of the first step with this k or a later one

  // docs/console.md, section API. Steps `from` on, with the events and commands of these steps.
  Json rows(std::uint64_t from) const;
  // Null: there is no such step.
  Json step(std::uint64_t number) const;
  // The step as it came. Nothing: there is no such step.
  std::optional<LoggedStep> logged(std::uint64_t number) const;
  std::vector<hal::Event> events_of(std::uint64_t number) const;

 private:
  struct Pending {
    LoggedStep step;
    std::uint32_t frames = 0, attitudes = 0, telemetries = 0, events = 0;
    std::uint32_t announced_commands = 0;
    std::vector<hal::Event> event_list;
    std::vector<std::string> commands;
    std::optional<hal::dds::StepDoneSample> done;
    bool has_step = false;
  };
  struct LoggedEvent {
    std::uint64_t step;
    hal::Event event;
  };
  struct LoggedCommand {
    std::uint64_t step;
    std::string text, outcome;
  };

  template <class Sample>
  Pending* pending_of(const Sample& sample);
  bool is_complete(const Pending& pending) const;
  void take_complete(std::size_t most_waiting);
  void take(const Pending& pending);
  bool is_step(const Pending& pending) const;
  void add_late(const hal::dds::TruthSample& sample);
  std::optional<hal::dds::TruthSample> truth_at_exposure(const LoggedStep& step) const;
  std::string outcome_of_commands(const LoggedStep& step) const;
  double seconds_of(std::int64_t time_ns) const;
  const LoggedStep* find(std::uint64_t number) const;  // null: there is no such step

  mutable std::mutex mutex_;
  std::uint32_t run_id_ = 0;
  bool is_bound_ = false;  // to a run
  // In which there are samples of these topics: a step waits for its own.
  bool has_steps_ = false, has_frames_ = false, has_truth_ = false;
  bool has_ended_ = false;
  bool expects_answers_ = true;
  std::string target_;
  std::map<std::uint32_t, Pending> pending_;  // by k
  std::uint32_t next_k_ = 0;                  // samples of earlier steps are too late
  std::deque<LoggedStep> steps_;
  std::uint64_t first_step_ = 0;  // number of steps_.front()
  std::int64_t first_time_ns_ = 0;
  std::deque<hal::dds::TruthSample> truths_;  // the newest
  std::deque<LoggedEvent> events_;
  std::deque<LoggedCommand> commands_;
};

}  // namespace tumblesight::sim
