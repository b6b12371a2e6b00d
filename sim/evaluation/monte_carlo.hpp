// Monte Carlo: the estimator on rendered sequences, directly (no DDS, no second process), on all cores.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sim/evaluation/metrics.hpp"
#include "sim/lidar/flash_lidar.hpp"
#include "sim/scenario/sequence.hpp"

namespace tumblesight::sim {

struct MonteCarloSettings {
  Condition condition = Condition::kNominal;
  std::uint64_t seed = 1;
  std::uint32_t sequences = 900;
  std::uint32_t frames = kFramesPerSequence;  // a sequence
  int threads = 1;
};

// `model`: a model image that AttitudeEstimator::load accepts; std::invalid_argument if it does not. The
// results are ordered by sequence and frame and do not depend on the number of threads. `progress`: sequences
// done so far; called on the calling thread.
std::vector<FrameResult> run_monte_carlo(const FlashLidar& lidar, double swath_m,
                                         const std::vector<std::uint8_t>& model,
                                         const MonteCarloSettings& settings,
                                         const std::function<void(std::uint32_t)>& progress);

}  // namespace tumblesight::sim
