#include "fsw/app/app_state.hpp"

namespace tumblesight::fsw {

gnc::FrameTimeLimits AppState::time_limits() const {
  return {std::int64_t{table[Parameter::kFutureTolerance_us]} * 1'000,
          std::int64_t{table[Parameter::kMaxFrameAge_ms]} * 1'000'000};
}

gnc::FrameTrackerLimits AppState::tracker_limits() const {
  return {time_limits(),
          std::int64_t{table[Parameter::kLongestCoast_ms]} * 1'000'000,
          std::int64_t{table[Parameter::kLongestWithoutChaser_ms]} * 1'000'000,
          std::int64_t{table[Parameter::kChaserTimeTolerance_us]} * 1'000,
          table[Parameter::kPredictedError_urad],
          table[Parameter::kAttitudeJump_urad]};
}

void Reporter::operator()(EventId id, std::int32_t a, std::int32_t b, std::int32_t c) const {
  log_.raise(state_.now_ns, id, {a, b, c}, state_.event_limits(), state_.counters);
}

}  // namespace tumblesight::fsw
