// SequenceResult: what the estimators made of one sequence. All figures of an evaluation are made from these
// alone, in the order of the sequences, so that it does not matter where or when each was made.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/evaluation/metrics.hpp"

namespace tumblesight::sim {

struct SequenceResult {
  std::uint32_t sequence = 0;
  std::vector<FrameResult> frames;  // those that were delivered, in their order
  double step_ms = 0.0;             // mean time per frame from ranges to attitude and pose, one thread
  double baseline_ms = 0.0;         // of the baseline on the last frame; 0: not run
};

}  // namespace tumblesight::sim
