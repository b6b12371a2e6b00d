#include "sim/sil/trace.hpp"

namespace tumblesight::sim {

void TraceDigest::add(std::uint32_t k, const StepResult& step) {
  crc_.add_u32(k);
  add_time(step.time_ns);
  add_report(step.attitude);
  add_telemetry(step.telemetry);
  for (const hal::Event& event : step.events) {
    if (!hal::depends_on_wall_clock(event.id)) add_event(event);
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
  crc_.add_u32(static_cast<std::uint32_t>(report.validity));
  crc_.add_u32(report.frames_since_reset);
  add_all(report.q_lrf_trf);
  crc_.add_u32(report.predicted_error_urad);
  add_all(report.q_lrf_trf_single_frame);
  crc_.add_u32(report.predicted_error_single_frame_urad);
  crc_.add_u32(report.doubts);
  crc_.add_u32(report.law);
  add_all(report.rate_lrf_urad_s);
  add_all(report.attitude_covariance_e8);
  add_all(report.rate_covariance_e8);
  add_all(report.q_lrf_trf_now);
  add_all(report.rate_lrf_now_urad_s);
  add_all(report.q_lrf_trf_second);
  crc_.add_u32(report.second_odds_ppm);
  add_all(report.centroid_lrf_mm);
  crc_.add_u32(report.pose_doubts);
  add_all(report.pose_q_lrf_trf);
  add_all(report.pose_origin_lrf_um);
  add_all(report.pose_rate_lrf_urad_s);
  add_all(report.pose_velocity_lrf_um_s);
  add_all(report.pose_sigma);
  add_all(report.pose_q_lrf_trf_now);
  add_all(report.pose_origin_lrf_now_um);
}

void TraceDigest::add_telemetry(const hal::Telemetry& telemetry) {
  add_time(telemetry.time_ns);
  for (const std::uint32_t value :
       {static_cast<std::uint32_t>(telemetry.mode), telemetry.cycles, telemetry.commands_accepted,
        telemetry.commands_refused, telemetry.frames_used, telemetry.frames_missing, telemetry.frames_refused,
        telemetry.frames_duplicate, telemetry.frames_stale, telemetry.frames_bad, telemetry.frames_repeated,
        telemetry.frames_without_chaser, telemetry.frames_superseded, telemetry.sequence_gaps,
        telemetry.estimator_resets, telemetry.attitudes_doubtful, telemetry.poses_verified,
        telemetry.model_passes}) {
    crc_.add_u32(value);
  }
}

void TraceDigest::add_event(const hal::Event& event) {
  add_time(event.time_ns);
  crc_.add_u32(static_cast<std::uint32_t>(event.id));
  crc_.add_u32(static_cast<std::uint32_t>(event.severity));
  for (const std::int32_t argument : event.arguments) crc_.add_u32(static_cast<std::uint32_t>(argument));
}

}  // namespace tumblesight::sim
