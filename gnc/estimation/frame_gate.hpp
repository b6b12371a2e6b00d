// FrameGate: the rules for time and order that a frame must pass before the estimator uses it. The gate knows
// only the last accepted frame.
//
//   the first rule that applies decides                                  verdict
//   sequence number equal to the last accepted one                       kDuplicate
//   exposure after the cycle time by more than future_tolerance_ns       kFromFuture
//   exposure not after the last accepted one                             kExposureBackwards
//   exposure more than max_age_ns before the cycle time                  kStale
//   exposure less than kShortestInterval_ns after the last accepted one  kTooSoon
//   otherwise                                                            kPass
#pragma once

#include <cstdint>

#include "gnc/lidar/range_image.hpp"

namespace tumblesight::gnc {

enum class FrameVerdict : std::uint8_t {
  kPass = 0,
  kDuplicate,
  kFromFuture,
  kExposureBackwards,
  kStale,
  kTooSoon,
  kRepeated,       // of one of the last used frames: a frozen sensor
  kBadContent,     // the estimator refuses it: FrameStatus
  kSuperseded,     // a newer frame of the same cycle is used instead
  kWithoutChaser,  // the track needs the chaser's attitude, and it is not known at this exposure
};

struct FrameTimeLimits {
  std::int64_t future_tolerance_ns;  // by which the sensor's clock may be ahead of the cycle's
  std::int64_t max_age_ns;           // an older frame says nothing about the current attitude
};

// later_ns - earlier_ns: 0 if the later time is not later; saturates.
std::int64_t time_after(std::int64_t earlier_ns, std::int64_t later_ns);

class FrameGate {
 public:
  [[nodiscard]] FrameVerdict judge(const RangeImage& frame, std::int64_t now_ns,
                                   const FrameTimeLimits& limits) const;

  // Number of sequence numbers between the last accepted frame and this one, modulo 2^32; kWentBack if this
  // number is lower or equal. 0 for the first frame.
  static constexpr std::uint32_t kWentBack = UINT32_MAX;
  std::uint32_t numbers_skipped(const RangeImage& frame) const;
  // Time from the last accepted exposure to this one, for a frame that passes; 0 for the first frame.
  // Saturates.
  std::int64_t elapsed_ns(const RangeImage& frame) const;

  void accept(const RangeImage& frame);
  void forget() { *this = FrameGate{}; }

  bool has_last() const { return has_last_; }
  std::uint32_t last_sequence_number() const { return last_sequence_number_; }
  std::int64_t last_exposure_time_ns() const { return last_exposure_time_ns_; }

 private:
  std::int64_t last_exposure_time_ns_ = 0;
  std::uint32_t last_sequence_number_ = 0;
  bool has_last_ = false;
};

}  // namespace tumblesight::gnc
