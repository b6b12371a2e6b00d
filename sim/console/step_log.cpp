#include "sim/console/step_log.hpp"

#include <algorithm>

#include "hal/dds/idl/hello.hpp"
#include "hal/dds/idl/sample_fields.hpp"
#include "hal/messages/event_text.hpp"
#include "sim/console/step_json.hpp"
#include "sim/recording/run_step.hpp"

namespace tumblesight::sim {
namespace {

// Steps that may wait for samples that are still on their way: topics have no order among each other.
constexpr std::size_t kMostWaiting = 4;
constexpr std::size_t kTruthsKept = 64;
constexpr std::size_t kMostEvents = 100'000, kMostCommands = 20'000;

template <class List>
void keep_newest(List& list, std::size_t most) {
  while (list.size() > most) list.pop_front();
}

template <class List>
auto from_step(const List& list, std::uint64_t step) {
  return std::lower_bound(list.begin(), list.end(), step,
                          [](const auto& entry, std::uint64_t wanted) { return entry.step < wanted; });
}

}  // namespace

bool StepLog::is_complete(const Pending& pending) const {
  const auto& done = pending.done;
  if (has_frames_ && pending.has_step && pending.frames < pending.step.frames) return false;
  // Those of the first step that a late console sees may have come before it.
  const bool is_late = next_k_ == 0 && pending.step.k > 0;
  if (pending.has_step && !is_late && pending.commands.size() < pending.announced_commands) return false;
  if (!expects_answers_) return pending.has_step && (!has_truth_ || pending.step.truth);
  if ((has_steps_ && !pending.has_step) || (has_truth_ && !pending.step.truth)) return false;
  return done && pending.attitudes >= done->attitudes && pending.telemetries >= done->telemetries &&
         pending.events >= done->events;
}

void StepLog::add(const hal::dds::HelloSample& hello) {
  if (hello.role != static_cast<std::uint8_t>(hal::dds::Role::kSimulator)) return;
  const std::lock_guard lock(mutex_);
  if (is_bound_ && hello.run_id == run_id_) return;
  is_bound_ = true;
  has_ended_ = has_steps_ = has_frames_ = has_truth_ = false;
  run_id_ = hello.run_id;
  target_ = hal::dds::target_of(hello).text;
  pending_.clear();
  steps_.clear();
  truths_.clear();
  events_.clear();
  commands_.clear();
  first_step_ = 0;
  next_k_ = 0;
}

template <class Sample>
StepLog::Pending* StepLog::pending_of(const Sample& sample) {
  if (!is_bound_ || sample.run_id != run_id_ || sample.k < next_k_) return nullptr;
  Pending& pending = pending_[sample.k];
  pending.step.k = sample.k;
  return &pending;
}

void StepLog::add(const hal::dds::TruthSample& sample) {
  const std::lock_guard lock(mutex_);
  if (is_bound_ && sample.run_id == run_id_) truths_.push_back(sample);
  keep_newest(truths_, kTruthsKept);
  Pending* const pending = pending_of(sample);
  if (pending == nullptr) return add_late(sample);
  pending->step.truth = sample;
  has_truth_ = true;
  take_complete(kMostWaiting);
}

// Before the first truth nobody knows that the run has one, and its step did not wait for it.
void StepLog::add_late(const hal::dds::TruthSample& sample) {
  if (!is_bound_ || sample.run_id != run_id_) return;
  has_truth_ = true;
  const auto found = std::find_if(steps_.rbegin(), steps_.rend(),
                                  [&sample](const LoggedStep& step) { return step.k <= sample.k; });
  if (found == steps_.rend() || found->k != sample.k) return;
  found->truth = sample;
  found->truth_of_attitude = truth_at_exposure(*found);
}

// The truth of a step has the time of the frame that its sensor took. An answer may be to an earlier frame:
// of a flight program on its own timer, or of a sensor that delivers late.
std::optional<hal::dds::TruthSample> StepLog::truth_at_exposure(const LoggedStep& step) const {
  if (!step.attitude || !gives_attitude(*step.attitude)) return std::nullopt;
  const auto found =
      std::find_if(truths_.rbegin(), truths_.rend(), [&step](const hal::dds::TruthSample& truth) {
        return truth.time_ns == step.attitude->exposure_time_ns;
      });
  return found == truths_.rend() ? std::nullopt : std::optional<hal::dds::TruthSample>(*found);
}

void StepLog::add(const hal::dds::StepSample& sample) {
  const std::lock_guard lock(mutex_);
  Pending* const pending = pending_of(sample);
  if (pending == nullptr) return;
  pending->step.time_ns = sample.time_ns;
  pending->step.frames = sample.frames;
  pending->announced_commands = sample.commands;
  pending->has_step = has_steps_ = true;
  take_complete(kMostWaiting);
}

// Its picture is kept elsewhere. A step is shown once there is one to show with it.
void StepLog::add(const hal::dds::LidarFrameSample& sample) {
  const std::lock_guard lock(mutex_);
  if (is_bound_ && sample.run_id == run_id_) has_frames_ = true;
  Pending* const pending = pending_of(sample);
  if (pending == nullptr) return;
  ++pending->frames;
  take_complete(kMostWaiting);
}

void StepLog::add(const hal::dds::CommandSample& sample) {
  const std::lock_guard lock(mutex_);
  Pending* const pending = pending_of(sample);
  if (pending == nullptr) return;
  pending->commands.push_back(text_of(sample));
  take_complete(kMostWaiting);
}

void StepLog::add(const hal::dds::AttitudeSample& sample) {
  const std::lock_guard lock(mutex_);
  Pending* const pending = pending_of(sample);
  if (pending == nullptr) return;
  hal::dds::copy_attitude_fields(sample, pending->step.attitude.emplace());
  // In a free run that of the flight program's cycle, which is another.
  if (!pending->has_step) pending->step.time_ns = sample.time_ns;
  ++pending->attitudes;
  take_complete(kMostWaiting);
}

void StepLog::add(const hal::dds::TelemetrySample& sample) {
  const std::lock_guard lock(mutex_);
  Pending* const pending = pending_of(sample);
  if (pending == nullptr) return;
  hal::dds::copy_telemetry_fields(sample, pending->step.telemetry.emplace());
  ++pending->telemetries;
  take_complete(kMostWaiting);
}

void StepLog::add(const hal::dds::EventSample& sample) {
  const std::lock_guard lock(mutex_);
  Pending* const pending = pending_of(sample);
  if (pending == nullptr) return;
  hal::dds::copy_event_fields(sample, pending->event_list.emplace_back());
  ++pending->events;
  take_complete(kMostWaiting);
}

void StepLog::add(const hal::dds::StepDoneSample& sample) {
  const std::lock_guard lock(mutex_);
  Pending* const pending = pending_of(sample);
  if (pending == nullptr) return;
  pending->done = sample;
  take_complete(kMostWaiting);
}

void StepLog::end() {
  const std::lock_guard lock(mutex_);
  take_complete(0);
  has_ended_ = true;
}

// In order. A step that more than `most_waiting` others follow lost a sample, and is taken as it is.
void StepLog::take_complete(std::size_t most_waiting) {
  while (!pending_.empty()) {
    const auto oldest = pending_.begin();
    if (!is_complete(oldest->second) && pending_.size() <= most_waiting) return;
    if (is_step(oldest->second)) take(oldest->second);
    next_k_ = oldest->first + 1;
    pending_.erase(oldest);
  }
}

// What a simulator announced and nobody has answered yet is none.
bool StepLog::is_step(const Pending& pending) const {
  return expects_answers_ ? pending.step.attitude || pending.done : pending.has_step;
}

void StepLog::take(const Pending& pending) {
  if (steps_.empty() && first_step_ == 0) first_time_ns_ = pending.step.time_ns;
  steps_.push_back(pending.step);
  steps_.back().truth_of_attitude = truth_at_exposure(pending.step);
  const std::uint64_t number = first_step_ + steps_.size() - 1;
  for (const hal::Event& event : pending.event_list) events_.push_back({number, event});
  const std::string outcome = outcome_of_commands(pending.step);
  for (const std::string& command : pending.commands) commands_.push_back({number, command, outcome});
  if (steps_.size() > kMostSteps) {
    steps_.pop_front();
    ++first_step_;
  }
  keep_newest(events_, kMostEvents);
  keep_newest(commands_, kMostCommands);
}

// By the counters of the telemetry before and after.
std::string StepLog::outcome_of_commands(const LoggedStep& step) const {
  const bool is_first = steps_.size() < 2;
  hal::Telemetry before;
  if (!is_first) before = steps_[steps_.size() - 2].telemetry.value_or(hal::Telemetry{});
  // Of a late console's first step nothing is known before.
  if (!step.telemetry || (is_first && step.k > 0)) return "sent";
  // RESET_COUNTERS begins them again.
  const bool is_reset = step.telemetry->commands_refused < before.commands_refused ||
                        step.telemetry->commands_accepted < before.commands_accepted;
  if (is_reset) before.commands_refused = before.commands_accepted = 0;
  if (step.telemetry->commands_refused == before.commands_refused) return "accepted";
  return step.telemetry->commands_accepted == before.commands_accepted ? "refused" : "in part refused";
}

StepLog::State StepLog::state() const {
  const std::lock_guard lock(mutex_);
  return {run_id_, first_step_ + steps_.size(), has_ended_};
}

std::string StepLog::target() const {
  const std::lock_guard lock(mutex_);
  return target_;
}

const LoggedStep* StepLog::find(std::uint64_t number) const {
  const bool exists = number >= first_step_ && number < first_step_ + steps_.size();
  return exists ? &steps_[number - first_step_] : nullptr;
}

std::int64_t StepLog::k_of(std::uint64_t number) const {
  const std::lock_guard lock(mutex_);
  const LoggedStep* const step = find(number);
  return step == nullptr ? -1 : std::int64_t{step->k};
}

std::int64_t StepLog::time_ns_of(std::uint64_t number) const {
  const std::lock_guard lock(mutex_);
  const LoggedStep* const step = find(number);
  return step == nullptr ? -1 : step->time_ns;
}

std::uint64_t StepLog::number_of(std::uint32_t k) const {
  const std::lock_guard lock(mutex_);
  const auto found =
      std::lower_bound(steps_.begin(), steps_.end(), k,
                       [](const LoggedStep& step, std::uint32_t wanted) { return step.k < wanted; });
  return first_step_ + static_cast<std::uint64_t>(found - steps_.begin());
}

double StepLog::seconds_of(std::int64_t time_ns) const {
  return 1e-9 * static_cast<double>(time_ns - first_time_ns_);
}

Json StepLog::rows(std::uint64_t from) const {
  const std::lock_guard lock(mutex_);
  const std::uint64_t end = first_step_ + steps_.size();
  const std::uint64_t first = std::min(std::max(from, first_step_), end);
  const std::uint64_t last = std::min<std::uint64_t>(end, first + kRowsPerAnswer);
  Json rows = Json::array(), events = Json::array(), commands = Json::array();
  for (std::uint64_t i = first; i < last; ++i) {
    const LoggedStep& step = steps_[i - first_step_];
    rows.push_back(row_of(step, seconds_of(step.time_ns)));
    rows.back()[0] = i;
  }
  for (auto at = from_step(events_, first); at != events_.end() && at->step < last; ++at) {
    const auto& a = at->event.arguments;
    events.push_back({at->step, seconds_of(at->event.time_ns), static_cast<int>(at->event.severity),
                      static_cast<int>(at->event.id),
                      std::string(text_of(at->event.id)) + " [" + std::to_string(a[0]) + ", " +
                          std::to_string(a[1]) + ", " + std::to_string(a[2]) + "]"});
  }
  for (auto at = from_step(commands_, first); at != commands_.end() && at->step < last; ++at)
    commands.push_back({at->step, seconds_of(steps_[at->step - first_step_].time_ns), at->text, at->outcome});
  return {{"from", first}, {"to", last}, {"rows", rows}, {"events", events}, {"commands", commands}};
}

Json StepLog::step(std::uint64_t number) const {
  const std::lock_guard lock(mutex_);
  const LoggedStep* const step = find(number);
  if (step == nullptr) return nullptr;
  Json detail = detail_of(*step, seconds_of(step->time_ns));
  detail["k"] = number;
  return detail;
}

std::optional<LoggedStep> StepLog::logged(std::uint64_t number) const {
  const std::lock_guard lock(mutex_);
  const LoggedStep* const step = find(number);
  return step == nullptr ? std::nullopt : std::optional<LoggedStep>(*step);
}

std::vector<hal::Event> StepLog::events_of(std::uint64_t number) const {
  const std::lock_guard lock(mutex_);
  std::vector<hal::Event> events;
  for (auto at = from_step(events_, number); at != events_.end() && at->step == number; ++at)
    events.push_back(at->event);
  return events;
}

}  // namespace tumblesight::sim
