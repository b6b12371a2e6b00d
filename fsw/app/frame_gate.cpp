#include "fsw/app/frame_gate.hpp"

#include "fsw/config/limits.hpp"

namespace tumblesight::fsw {
namespace {

// later - earlier, for later >= earlier. Exact where the signed difference would overflow.
std::uint64_t elapsed_ns(std::int64_t earlier_ns, std::int64_t later_ns) {
  return static_cast<std::uint64_t>(later_ns) - static_cast<std::uint64_t>(earlier_ns);
}

}  // namespace

FrameVerdict FrameGate::judge(const gnc::RangeImage& frame, std::int64_t now_ns) const {
  if (has_last_ && frame.sequence_number == last_sequence_number_) return FrameVerdict::kDuplicate;
  if (frame.exposure_time_ns > now_ns) return FrameVerdict::kFromFuture;
  if (has_last_ && frame.exposure_time_ns <= last_exposure_time_ns_) return FrameVerdict::kExposureBackwards;
  if (elapsed_ns(frame.exposure_time_ns, now_ns) > static_cast<std::uint64_t>(config::kMaxFrameAge_ns)) {
    return FrameVerdict::kStale;
  }
  return FrameVerdict::kPass;
}

std::uint32_t FrameGate::numbers_skipped(const gnc::RangeImage& frame) const {
  if (!has_last_) return 0;
  const std::uint32_t ahead = frame.sequence_number - last_sequence_number_;
  constexpr std::uint32_t kHalfCircle = 0x8000'0000U;
  return ahead < kHalfCircle ? ahead - 1 : kWentBack;  // an equal number gives 0 - 1, which is kWentBack
}

bool FrameGate::one_period_after_last(const gnc::RangeImage& frame) const {
  if (!has_last_ || frame.exposure_time_ns <= last_exposure_time_ns_) return false;
  const std::uint64_t gap_ns = elapsed_ns(last_exposure_time_ns_, frame.exposure_time_ns);
  return gap_ns >= static_cast<std::uint64_t>(config::kFramePeriod_ns - config::kFramePeriodTolerance_ns) &&
         gap_ns <= static_cast<std::uint64_t>(config::kFramePeriod_ns + config::kFramePeriodTolerance_ns);
}

void FrameGate::accept(const gnc::RangeImage& frame) {
  last_exposure_time_ns_ = frame.exposure_time_ns;
  last_sequence_number_ = frame.sequence_number;
  has_last_ = true;
}

}  // namespace tumblesight::fsw
