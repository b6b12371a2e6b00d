#include "sim/console/ros2_bridge.hpp"

#include <algorithm>
#include <stdexcept>

#include "sim/recording/run_step.hpp"

namespace tumblesight::sim {

Ros2Bridge::Ros2Bridge(const RunSource& run, std::uint32_t domain)
    : run_(run),
      domain_(domain),
      points_(domain_, "lidar/points"),
      pose_(domain_, "target/pose"),
      true_pose_(domain_, "target/pose_true"),
      twist_(domain_, "target/twist"),
      transforms_(domain_, "tf"),
      frame_(std::make_unique<gnc::RangeImage>()) {
  const StepLog::State state = run_.log().state();
  run_id_ = state.run_id;
  next_ = next_frame_ = state.steps == 0 ? 0 : state.steps - 1;
}

void Ros2Bridge::begin_run() {
  next_ = next_frame_ = 0;
  first_ns_.reset();
}

void Ros2Bridge::poll() {
  const StepLog::State state = run_.log().state();
  if (state.run_id != run_id_) begin_run();
  run_id_ = state.run_id;
  try {
    const std::uint64_t end = std::min(state.steps, next_ + kStepsPerPoll);
    while (next_ < end)
      if (const std::optional<LoggedStep> step = run_.log().logged(next_++)) publish_step(*step);
    publish_points();
    points_.repeat_for_new_readers();
    pose_.repeat_for_new_readers();
    true_pose_.repeat_for_new_readers();
    twist_.repeat_for_new_readers();
    transforms_.repeat_for_new_readers();
  } catch (const std::runtime_error& error) {
    failure_ = error.what();
  }
}

void Ros2Bridge::publish_step(const LoggedStep& step) {
  if (!first_ns_) first_ns_ = run_.log().logged(0).value_or(step).time_ns;
  const std::int64_t step_ns = shown_time_ns(step.time_ns);
  const hal::dds::TruthSample* const truth = step.truth ? &*step.truth : nullptr;
  true_pose_.publish(truth == nullptr ? std::nullopt : true_pose(*truth, step_ns));
  hal::AttitudeReport report;
  report.validity = hal::Validity::kNoFrame;
  if (step.attitude) report = *step.attitude;
  // When the points were measured from which it is.
  const std::int64_t report_ns = gives_attitude(report) ? shown_time_ns(report.exposure_time_ns) : step_ns;
  pose_.publish(estimated_pose(report, report_ns));
  twist_.publish(estimated_twist(report, report_ns));
  transforms_.publish(transforms(report, report_ns, truth, step_ns));
}

// Frames are large, and may come later than the small samples of their step. Until the next step they are
// waited for.
void Ros2Bridge::publish_points() {
  while (next_frame_ < next_) {
    const bool is_newest = next_frame_ + 1 == next_;
    bool has_frame = false;
    try {
      has_frame = run_.frame(next_frame_, *frame_);
    } catch (const std::runtime_error&) {
      ++next_frame_;  // it cannot be read, now or later
      throw;
    }
    if (!has_frame && is_newest) return;
    ++next_frame_;
    if (has_frame) points_.publish(Ros2Points(*frame_, shown_time_ns(frame_->exposure_time_ns)));
  }
}

// As in a recording: times of messages are not negative, those of a run may be.
std::int64_t Ros2Bridge::shown_time_ns(std::int64_t time_ns) const {
  return std::max<std::int64_t>(0, time_ns - std::min<std::int64_t>(0, first_ns_.value_or(0)));
}

}  // namespace tumblesight::sim
