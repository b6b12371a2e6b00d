// Limits and budgets of the flight application, in one place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tumblesight::fsw {

// What SET_LIMIT can change. Numbers are part of the interface (docs/icd.md).
enum class Limit : std::uint8_t {
  kPredictedError_urad = 0,  // an attitude that expects more is doubtful
  kAttitudeJump_urad = 1,    // farther than this from where the last two attitudes lead to: doubtful
  kStepBudget_us = 2,        // a step that takes longer is an overrun
  kScrubBlocks = 3,          // blocks of the model that are checked in a cycle
};
inline constexpr int kLimits = 4;

namespace config {

struct LimitRule {
  Limit limit;
  std::uint32_t lowest;
  std::uint32_t highest;
  std::uint32_t initial;
};

inline constexpr std::size_t kModelBlockBytes = 4096;

// A step may take half the period; the other half belongs to whoever uses the attitude.
inline constexpr std::array<LimitRule, kLimits> kLimitRules{{
    {Limit::kPredictedError_urad, 17'453, 3'141'593, 523'599},
    {Limit::kAttitudeJump_urad, 87'266, 3'141'593, 1'047'198},
    {Limit::kStepBudget_us, 1'000, 2'700'000, 1'350'000},
    {Limit::kScrubBlocks, 1, 64, 12},
}};

// What one step takes in. More than this waits in the HAL for the next cycle.
inline constexpr int kMaxCommandsPerStep = 8;
// Two, so that a frame that came a cycle late is caught up with instead of leaving the task one frame behind
// for good.
inline constexpr int kMaxFramesPerStep = 2;

// What one step hands out; what is left over waits for the next one, and what does not fit there either is
// counted as lost.
inline constexpr int kMaxEventsPerStep = 16;
inline constexpr int kEventRing = 32;
static_assert((kEventRing & (kEventRing - 1)) == 0, "a damaged place in the ring is masked");
// Of one kind, within a window of so many cycles, no more are told; the window's end tells how many there
// were.
inline constexpr int kMaxEventsOfAKind = 8;
inline constexpr std::uint32_t kEventWindow_cycles = 16;

// The network has learnt motion in steps of one frame period; a step off by more than the tolerance is
// another motion.
inline constexpr std::int64_t kFramePeriod_ns = 2'700'000'000;
inline constexpr std::int64_t kFramePeriodTolerance_ns = kFramePeriod_ns / 10;
static_assert(kFramePeriodTolerance_ns > 0 && 2 * kFramePeriodTolerance_ns < kFramePeriod_ns,
              "a gap of two periods must not pass for one");

// A frame exposed longer ago than this says nothing about the attitude now. One cycle late is still of use.
inline constexpr std::int64_t kMaxFrameAge_ns = kFramePeriod_ns + kFramePeriodTolerance_ns;

// Static memory of AttitudeInitApp in fixed point. Weights are read where the model image lies and do not
// count.
inline constexpr std::size_t kMaxAppBytes = 128U * 1024U;
inline constexpr std::size_t kMaxModelImageBytes = 8U * 1024U * 1024U;

}  // namespace config
}  // namespace tumblesight::fsw
