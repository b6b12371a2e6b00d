// FrameGate: the rules for time and order that a frame must pass before the estimator uses it. The gate knows
// only the last accepted frame. The estimator checks the content of a frame.
//
//   the first rule that applies decides                                  verdict
//   sequence number equal to the last accepted one                       kDuplicate
//   exposure after the cycle time                                        kFromFuture
//   exposure not after the last accepted one                             kExposureBackwards
//   exposure more than config::kMaxFrameAge_ns before the cycle time     kStale
//   otherwise                                                            kPass
#pragma once

#include <cstdint>

#include "gnc/lidar/range_image.hpp"

namespace tumblesight::fsw {

enum class FrameVerdict : std::uint8_t { kPass = 0, kDuplicate, kFromFuture, kExposureBackwards, kStale };

class FrameGate {
 public:
  [[nodiscard]] FrameVerdict judge(const gnc::RangeImage& frame, std::int64_t now_ns) const;

  // Number of sequence numbers between the last accepted frame and this one, modulo 2^32; kWentBack if this
  // number is lower or equal. 0 for the first frame.
  static constexpr std::uint32_t kWentBack = UINT32_MAX;
  std::uint32_t numbers_skipped(const gnc::RangeImage& frame) const;
  // Whether the exposure is one period +- 10 % after the last accepted one. False for the first frame.
  bool one_period_after_last(const gnc::RangeImage& frame) const;

  void accept(const gnc::RangeImage& frame);
  void forget() { *this = FrameGate{}; }

  bool has_last() const { return has_last_; }
  std::uint32_t last_sequence_number() const { return last_sequence_number_; }
  std::int64_t last_exposure_time_ns() const { return last_exposure_time_ns_; }

 private:
  std::int64_t last_exposure_time_ns_ = 0;
  std::uint32_t last_sequence_number_ = 0;
  bool has_last_ = false;
};

}  // namespace tumblesight::fsw
