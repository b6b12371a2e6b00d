#include "sim/sil/answer_check.hpp"

#include <algorithm>

#include "sim/sil/sil_run.hpp"

namespace tumblesight::sim {

void AnswerCheck::sent(std::uint32_t k, std::int64_t time_ns,
                       const std::vector<const gnc::RangeImage*>& frames) {
  k_ = k;
  time_ns_ = time_ns;
  if (!free_running_) frames_.clear();
  for (const gnc::RangeImage* frame : frames)
    frames_.emplace(frame->sequence_number, frame->exposure_time_ns);
}

std::string AnswerCheck::fault_of(const StepAnswer& answer) const {
  if (!free_running_) {
    const std::string fault = step_fault(answer);
    if (!fault.empty()) return fault;
  }
  if (answer.telemetry.time_ns != answer.attitude.time_ns) {
    return "attitude and telemetry of an answer have the cycle times " +
           std::to_string(answer.attitude.time_ns) + " ns and " + std::to_string(answer.telemetry.time_ns) +
           " ns";
  }
  const bool later = std::any_of(answer.events.begin(), answer.events.end(), [&](const hal::Event& event) {
    return event.time_ns > answer.telemetry.time_ns;
  });
  if (later) return "an event is later than the cycle that it came with";
  const auto frame = std::make_pair(answer.attitude.sequence_number, answer.attitude.exposure_time_ns);
  if (gives_attitude(answer.attitude) && frames_.count(frame) == 0) {
    return "an attitude is to a frame that was not sent: sequence number " + std::to_string(frame.first) +
           ", exposure time " + std::to_string(frame.second) + " ns";
  }
  return {};
}

std::string AnswerCheck::step_fault(const StepAnswer& answer) const {
  if (answer.k != k_)
    return "an answer is to step " + std::to_string(answer.k) + " instead of step " + std::to_string(k_);
  if (answer.attitude.time_ns == time_ns_ && answer.telemetry.time_ns == time_ns_) return {};
  return "the answer to step " + std::to_string(k_) + " has the cycle time " +
         std::to_string(answer.telemetry.time_ns) + " ns instead of " + std::to_string(time_ns_) + " ns";
}

}  // namespace tumblesight::sim
