// Sizes and budgets of the flight application. What the ground can change is in parameters.inc.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumblesight::fsw {

namespace config {

inline constexpr std::size_t kModelBlockBytes = 4096;
// Segments of an upload that one cycle copies from the bank in use, or up to three more where segments are
// written together. A whole image takes about 40 cycles.
inline constexpr std::uint32_t kCopiedSegmentsPerCycle = 32;

// Inputs of one step. Everything beyond these limits waits in the HAL for the next cycle.
inline constexpr int kMaxCommandsPerStep = 8;
// Deliveries of the LiDAR that one cycle receives: frames, and data that is not a frame. The estimator gets
// one frame, the newest usable one, so that a sensor that is faster than the cycle neither fills the queue
// nor lengthens the step.
inline constexpr int kMaxDeliveriesPerCycle = 32;
// Frames with bad content after which the rest of a cycle's deliveries counts as bad without a look.
inline constexpr int kMaxBadContentsPerCycle = 3;
// A cycle's first frames that are compared in full with the used ones and with the one before, and the most
// that are: after these the last comparison's result stands for the frames that begin alike.
inline constexpr int kFramesComparedInFull = 2;
inline constexpr int kMaxFullComparisonsPerCycle = 4;

// Events that one step returns. Further events wait in the ring for the next step; events that do not fit
// into the ring are counted as lost.
inline constexpr int kMaxEventsPerStep = 16;
inline constexpr int kEventRing = 32;
static_assert((kEventRing & (kEventRing - 1)) == 0, "the ring's indices are masked");

// The persistent store (fsw/app/state_keeper.hpp).
inline constexpr int kStoreReads = 3;                    // of a copy at boot, until one succeeds
inline constexpr std::uint32_t kMostFailingCycles = 10;  // then failing copies are written at the checks only
inline constexpr std::uint32_t kStoreCheck_cycles =
    64;  // both copies are read, and written if they have changed

// The period of the cycle.
inline constexpr std::int64_t kFramePeriod_ns = 2'700'000'000;

// Static memory of AttitudeInitApp in fixed point. It does not include the weights, which are read from the
// model image in place, nor gnc::kKernelScratchBytes, which are 0 except on x86.
inline constexpr std::size_t kMaxAppBytes = 176U * 1024U;
inline constexpr std::size_t kMaxModelImageBytes = 8U * 1024U * 1024U;

}  // namespace config
}  // namespace tumblesight::fsw
