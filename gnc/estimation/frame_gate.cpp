#include "gnc/estimation/frame_gate.hpp"

#include "gnc/rcnn/attitude_track.hpp"

namespace tumblesight::gnc {
namespace {

// later - earlier, for later >= earlier. Exact where the signed difference would overflow.
std::uint64_t difference_ns(std::int64_t earlier_ns, std::int64_t later_ns) {
  return static_cast<std::uint64_t>(later_ns) - static_cast<std::uint64_t>(earlier_ns);
}

bool is_later_by_more_than(std::int64_t limit_ns, std::int64_t earlier_ns, std::int64_t later_ns) {
  return later_ns > earlier_ns && difference_ns(earlier_ns, later_ns) > static_cast<std::uint64_t>(limit_ns);
}

}  // namespace

std::int64_t time_after(std::int64_t earlier_ns, std::int64_t later_ns) {
  if (later_ns <= earlier_ns) return 0;
  const std::uint64_t after_ns = difference_ns(earlier_ns, later_ns);
  return after_ns < INT64_MAX ? static_cast<std::int64_t>(after_ns) : INT64_MAX;
}

FrameVerdict FrameGate::judge(const RangeImage& frame, std::int64_t now_ns,
                              const FrameTimeLimits& limits) const {
  const std::int64_t exposure_ns = frame.exposure_time_ns;
  if (has_last_ && frame.sequence_number == last_sequence_number_) return FrameVerdict::kDuplicate;
  if (is_later_by_more_than(limits.future_tolerance_ns, now_ns, exposure_ns))
    return FrameVerdict::kFromFuture;
  if (has_last_ && exposure_ns <= last_exposure_time_ns_) return FrameVerdict::kExposureBackwards;
  if (is_later_by_more_than(limits.max_age_ns, exposure_ns, now_ns)) return FrameVerdict::kStale;
  if (has_last_ && elapsed_ns(frame) < kShortestInterval_ns) return FrameVerdict::kTooSoon;
  return FrameVerdict::kPass;
}

std::uint32_t FrameGate::numbers_skipped(const RangeImage& frame) const {
  if (!has_last_) return 0;
  const std::uint32_t ahead = frame.sequence_number - last_sequence_number_;
  constexpr std::uint32_t kHalfCircle = 0x8000'0000U;
  return ahead < kHalfCircle ? ahead - 1 : kWentBack;  // an equal number gives 0 - 1, which is kWentBack
}

std::int64_t FrameGate::elapsed_ns(const RangeImage& frame) const {
  return has_last_ ? time_after(last_exposure_time_ns_, frame.exposure_time_ns) : 0;
}

void FrameGate::accept(const RangeImage& frame) {
  last_exposure_time_ns_ = frame.exposure_time_ns;
  last_sequence_number_ = frame.sequence_number;
  has_last_ = true;
}

}  // namespace tumblesight::gnc
