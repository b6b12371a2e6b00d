// Limits and budgets of the flight application.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "gnc/tracking/frame_gate.hpp"
#include "hal/messages/limit.hpp"

namespace tumblesight::fsw {

using hal::kLimits;
using hal::Limit;

namespace config {

// The range that SET_LIMIT accepts, and the value after init().
struct LimitRule {
  Limit limit;
  std::uint32_t lowest;
  std::uint32_t highest;
  std::uint32_t initial;
};

inline constexpr std::size_t kModelBlockBytes = 4096;

// A step may take half the frame period; the other half is for the users of the attitude. The largest
// scrubbing beside a frame still leaves 2 % of that on the slowest processor (docs/audit.md).
inline constexpr std::array<LimitRule, kLimits> kLimitRules{{
    {Limit::kPredictedError_urad, 17'453, 3'141'593, 523'599},
    {Limit::kAttitudeJump_urad, 87'266, 3'141'593, 1'047'198},
    {Limit::kStepBudget_us, 1'000, 2'700'000, 1'350'000},
    {Limit::kScrubBlocks, 1, 32, 12},
}};

// Inputs of one step. Everything beyond these limits waits in the HAL for the next cycle.
inline constexpr int kMaxCommandsPerStep = 8;
// Deliveries of the LiDAR that one cycle receives: frames, and data that is not a frame. The estimator gets
// one frame, the newest usable one, so that a sensor that is faster than the cycle neither fills the queue
// nor lengthens the step.
inline constexpr int kMaxDeliveriesPerCycle = 32;

// Events that one step returns. Further events wait in the ring for the next step; events that do not fit
// into the ring are counted as lost.
inline constexpr int kMaxEventsPerStep = 16;
inline constexpr int kEventRing = 32;
static_assert((kEventRing & (kEventRing - 1)) == 0, "the ring's indices are masked");
// At most this many events of one kind are sent per window. At the end of the window one event reports how
// many were suppressed.
inline constexpr int kMaxEventsOfAKind = 8;
inline constexpr std::uint32_t kEventWindow_cycles = 16;

// The period of the cycle.
inline constexpr std::int64_t kFramePeriod_ns = 2'700'000'000;

// An older frame says little about the current attitude. A frame that is one cycle late is still accepted.
// The clocks of sensor and cycle differ by less than the tolerance.
inline constexpr std::int64_t kMaxFrameAge_ns = kFramePeriod_ns + kFramePeriod_ns / 10;
inline constexpr std::int64_t kFutureTolerance_ns = 1'000'000;
inline constexpr gnc::FrameTimeLimits kFrameTimeLimits{kFutureTolerance_ns, kMaxFrameAge_ns};

// After a longer time without a used frame the track is given up. After 8 periods the first frame is within
// 20 degrees in 100 % of 300 sequences of NEAR Shoemaker (occluded: 91 %) with the track that coasted, and in
// 98 % (87 %) without it.
inline constexpr std::int64_t kLongestCoast_ns = 8 * kFramePeriod_ns;
// While the chaser's attitude fails for at most this time, its frames are not used and the track coasts.
inline constexpr std::int64_t kLongestWithoutChaser_ns = 3 * kFramePeriod_ns;
// At 5 degrees/s of the chaser an attitude that is 10 ms off is wrong by 0.05 degrees.
inline constexpr std::int64_t kChaserTimeTolerance_ns = 10'000'000;

// Static memory of AttitudeInitApp in fixed point. It does not include the weights, which are read from the
// model image in place.
inline constexpr std::size_t kMaxAppBytes = 128U * 1024U;
inline constexpr std::size_t kMaxModelImageBytes = 8U * 1024U * 1024U;

}  // namespace config
}  // namespace tumblesight::fsw
