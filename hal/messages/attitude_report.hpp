// AttitudeReport: the result of one cycle.
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::hal {

// Whether the attitudes of a report can be used. For every value except kValid and kDoubtful the attitudes
// are the identity with an expected error of pi, and exposure time, sequence number and frames_since_reset
// are 0.
enum class Validity : std::uint8_t {
  kValid = 0,
  kStandby = 1,       // the mode is not RUN
  kNoFrame = 2,       // no frame arrived in this cycle
  kFrameRefused = 3,  // a frame arrived and was refused; the event gives the reason
  kDoubtful = 4,      // the expected error is too large, the attitude has jumped, or the frame is frozen
};

// Quaternions: Hamilton, scalar first (w, x, y, z), target frame (TRF) to LiDAR frame (LRF), unit norm, Q30.
// Expected errors: 0 ... pi.
struct AttitudeReport {
  std::int64_t time_ns = 0;           // cycle time
  std::int64_t exposure_time_ns = 0;  // of the frame that gave the attitude
  std::uint32_t sequence_number = 0;  // of that frame
  Validity validity = Validity::kValid;
  std::uint32_t frames_since_reset = 0;
  std::array<std::int32_t, 4> q_lrf_trf{1 << 30, 0, 0, 0};  // from all frames since the reset
  std::uint32_t predicted_error_urad = 0;
  std::array<std::int32_t, 4> q_lrf_trf_single_frame{1 << 30, 0, 0, 0};  // from the last frame alone
  std::uint32_t predicted_error_single_frame_urad = 0;
};

}  // namespace tumblesight::hal
