// Monte Carlo: the estimators on rendered sequences, directly (no DDS, no second process), on all cores.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sim/baseline/template_matcher.hpp"
#include "sim/evaluation/metrics.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {

struct MonteCarloSettings {
  ScenarioSettings scenario;  // the frames of a sequence among them
  std::uint64_t seed = 1;
  std::uint32_t sequences = 900;
  std::uint32_t baseline_sequences = 0;  // the first ones, of whose last frame the baseline is asked as well
  int threads = 1;
};

// What the frames are made of.
struct Sensor {
  const FlashLidar& lidar;
  double swath_m;
};

struct MonteCarloResult {
  std::vector<FrameResult> frames;  // ordered by sequence and frame
  double network_ms = 0.0;          // median time of a frame from ranges to attitude, one thread
  double baseline_ms = 0.0;         // the same of the baseline; 0 when it was not run
};

// `model`: a model image that AttitudeEstimator::load accepts; std::invalid_argument if it does not. All but
// the times is the same with any number of threads. `matcher`: the baseline, or nullptr.
// `progress`: sequences done so far; called on the calling thread.
//
// Sequence i is make_sequence(scenario, seed, i), as in `simulate`, so that a run over DDS can be compared
// with one without. No network was trained or tuned on it: training draws from mix(seed, attempt), 64-bit
// hashes that no seed a person gives is equal to.
MonteCarloResult run_monte_carlo(const Sensor& sensor, const std::vector<std::uint8_t>& model,
                                 const TemplateMatcher* matcher, const MonteCarloSettings& settings,
                                 const std::function<void(std::uint32_t)>& progress);

}  // namespace tumblesight::sim
