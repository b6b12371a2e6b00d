#include "sim/sil/trace.hpp"

namespace tumblesight::sim {

void TraceDigest::add(std::uint32_t k, const StepResult& step) {
  crc_.add_u32(k);
  add_time(step.time_ns);
  add_report(step.attitude);
  add_housekeeping(step.housekeeping);
  for (const hal::Event& event : step.events) {
    if (!hal::tells_of_wall_clock(event.id)) add_event(event);
  }
  crc_.add_u32(step.state_crc32);
}

void TraceDigest::add_time(std::int64_t time_ns) {
  const auto bits = static_cast<std::uint64_t>(time_ns);
  crc_.add_u32(static_cast<std::uint32_t>(bits));
  crc_.add_u32(static_cast<std::uint32_t>(bits >> 32));
}

void TraceDigest::add_report(const hal::AttitudeReport& report) {
  add_time(report.time_ns);
  add_time(report.exposure_time_ns);
  crc_.add_u32(report.sequence_number);
  crc_.add_u32(report.validity);
  crc_.add_u32(report.frames_since_reset);
  for (const std::int32_t part : report.q_lrf_trf) crc_.add_u32(static_cast<std::uint32_t>(part));
  crc_.add_u32(report.predicted_error_urad);
  for (const std::int32_t part : report.q_lrf_trf_single_frame)
    crc_.add_u32(static_cast<std::uint32_t>(part));
  crc_.add_u32(report.predicted_error_single_frame_urad);
}

void TraceDigest::add_housekeeping(const hal::Housekeeping& housekeeping) {
  add_time(housekeeping.time_ns);
  for (const std::uint32_t value :
       {std::uint32_t{housekeeping.mode}, housekeeping.cycles, housekeeping.commands_accepted,
        housekeeping.commands_refused, housekeeping.frames_used, housekeeping.frames_missing,
        housekeeping.frames_refused, housekeeping.frames_duplicate, housekeeping.frames_stale,
        housekeeping.frames_bad, housekeeping.sequence_gaps, housekeeping.estimator_resets,
        housekeeping.attitudes_doubtful, housekeeping.model_passes}) {
    crc_.add_u32(value);
  }
}

void TraceDigest::add_event(const hal::Event& event) {
  add_time(event.time_ns);
  crc_.add_u32(event.id);
  crc_.add_u32(event.severity);
  for (const std::int32_t argument : event.arguments) crc_.add_u32(static_cast<std::uint32_t>(argument));
}

}  // namespace tumblesight::sim
