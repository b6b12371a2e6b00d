// Limits and budgets of the flight application, in one place.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumblesight::fsw::config {

// What one step takes in. More than this waits in the HAL for the next cycle.
inline constexpr int kMaxCommandsPerStep = 8;
// Two, so that a frame that came a cycle late is caught up with instead of leaving the task one frame behind
// for good.
inline constexpr int kMaxFramesPerStep = 2;

// What one step can report: one event a command, at most two a frame (numbers skipped, estimator reset), one
// for the model, at most two assertions. The event of a cycle time that does not advance takes the place of
// the frames'.
inline constexpr int kMaxEventsPerFrame = 2;
inline constexpr int kMaxEventsPerStep = 16;
static_assert(kMaxEventsPerStep >= kMaxCommandsPerStep + kMaxFramesPerStep * kMaxEventsPerFrame + 3,
              "a step could raise more events than it can hand out");

// The network has learnt motion in steps of one frame period; a step off by more than the tolerance is
// another motion.
inline constexpr std::int64_t kFramePeriod_ns = 2'700'000'000;
inline constexpr std::int64_t kFramePeriodTolerance_ns = kFramePeriod_ns / 10;
static_assert(kFramePeriodTolerance_ns > 0 && 2 * kFramePeriodTolerance_ns < kFramePeriod_ns,
              "a gap of two periods must not pass for one");

// A frame exposed longer ago than this says nothing about the attitude now. One cycle late is still of use.
inline constexpr std::int64_t kMaxFrameAge_ns = kFramePeriod_ns + kFramePeriodTolerance_ns;

// A step may take half the period; the other half belongs to whoever uses the attitude.
inline constexpr std::int64_t kStepBudget_ns = kFramePeriod_ns / 2;
static_assert(kStepBudget_ns < kFramePeriod_ns, "a step must end before the next one starts");

// Static memory of AttitudeInitApp in fixed point. Weights are read where the model image lies and do not count.
inline constexpr std::size_t kMaxAppBytes = 128U * 1024U;
inline constexpr std::size_t kMaxModelImageBytes = 8U * 1024U * 1024U;

}  // namespace tumblesight::fsw::config
