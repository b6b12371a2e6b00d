#include "sim/console/shown_run.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "sim/recording/step_samples.hpp"

namespace tumblesight::sim {
namespace {

hal::AttitudeReport no_frame() {
  hal::AttitudeReport report;
  report.validity = hal::Validity::kNoFrame;
  return report;
}

}  // namespace

void ShownRun::begin() {
  run_id_ = run_.log().state().run_id;
}

void ShownRun::follow(std::uint32_t id, View view) {
  const std::uint64_t steps = run_.log().state().steps;
  followed_[id] = {view, steps == 0 ? 0 : steps - 1};
}

const View* ShownRun::find(std::uint32_t id) const {
  const auto found = followed_.find(id);
  return found == followed_.end() ? nullptr : &found->second.view;
}

const std::uint32_t* ShownRun::find(View view) const {
  const auto found = std::find_if(followed_.begin(), followed_.end(),
                                  [view](const auto& one) { return one.second.view == view; });
  return found == followed_.end() ? nullptr : &found->first;
}

std::vector<ShownRun::Message> ShownRun::poll() {
  const StepLog::State state = run_.log().state();
  if (state.run_id != run_id_) {
    run_id_ = state.run_id;
    time_ = {};
    for (auto& [id, followed] : followed_) followed.next = 0;
  }
  std::uint64_t first = state.steps;
  for (const auto& [id, followed] : followed_) first = std::min(first, followed.next);
  const std::uint64_t last = std::min(state.steps, first + kStepsPerPoll);
  std::vector<Message> out;
  for (std::uint64_t number = first; number < last; ++number)
    add_step(number, number + 1 == state.steps, out);
  return out;
}

void ShownRun::add_step(std::uint64_t number, bool is_newest, std::vector<Message>& out) {
  const std::optional<LoggedStep> step = run_.log().logged(number);
  if (step) time_.begin_with(run_.log().logged(0).value_or(*step).time_ns);
  for (auto& [id, followed] : followed_) {
    if (followed.next != number) continue;
    const bool is_points = followed.view == View::kPoints;
    if (step && is_points && is_newest && !add_points(number, step->time_ns, id, out)) continue;
    if (step && !is_points) add_messages(*step, number, id, followed.view, out);
    ++followed.next;
  }
}

bool ShownRun::add_points(std::uint64_t number, std::int64_t time_ns, std::uint32_t id,
                          std::vector<Message>& out) {
  const auto frame = std::make_unique<gnc::RangeImage>();
  try {
    // Large samples may come later than the small ones of their step. Until the next step they are waited
    // for.
    if (!run_.frame(number, *frame)) return false;
    ShownStep step;
    step.time_ns = time_ns;
    step.frames = {frame.get()};
    add(step, id, View::kPoints, out);
  } catch (const std::runtime_error& error) {
    out.push_back({id, time_(time_ns), std::string("the frame cannot be read: ") + error.what(), true});
  }
  return true;
}

void ShownRun::add_messages(const LoggedStep& logged, std::uint64_t number, std::uint32_t id, View view,
                            std::vector<Message>& out) {
  const hal::AttitudeReport report = logged.attitude.value_or(no_frame());
  // At the time of the attitude, if there is one.
  const auto& sample = gives_attitude(report) ? logged.truth_of_attitude : logged.truth;
  const FrameTruth truth = sample ? frame_truth_of(*sample) : FrameTruth{};
  ShownStep step;
  step.time_ns = logged.time_ns;
  step.report = &report;
  if (sample) step.truth = &truth;
  if (view == View::kLog) step.events = run_.log().events_of(number);
  add(step, id, view, out);
}

void ShownRun::add(const ShownStep& step, std::uint32_t id, View view, std::vector<Message>& out) const {
  for (const std::string& json : messages_of(step, time_, view))
    out.push_back({id, time_(step.time_ns), json, false});
}

}  // namespace tumblesight::sim
