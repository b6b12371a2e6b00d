// Monte Carlo: the estimators on rendered sequences in this process (no DDS), with several threads.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sim/baseline/template_matcher.hpp"
#include "sim/experiment/sequence_result.hpp"
#include "sim/world/frame_renderer.hpp"
#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::sim {

struct MonteCarloSettings {
  ScenarioSettings scenario;  // with the number of frames per sequence
  std::uint64_t seed = 1;
  std::uint32_t sequences = 900;
  std::uint32_t baseline_sequences = 0;  // the baseline runs on the last frame of the first ones
  int threads = 1;
  TargetSymmetry symmetry{};  // errors are to the nearest attitude that looks the same
};

// Takes the result of a sequence. Called by one thread at a time, in no fixed order.
using SequenceSink = std::function<void(SequenceResult&&)>;

// Runs the sequences `indices`, each through the same gnc::FrameTracker as in flight. `renderer`: renders the
// frames. `model`: a model image that AttitudeEstimator::load accepts; otherwise throws
// std::invalid_argument. `matcher`: the baseline, or nullptr.
// `progress`: sequences done so far; called on the calling thread. The results except the times do not depend
// on the number of threads, nor on which other sequences run. What `take` throws ends the run and is thrown
// on.
//
// Sequence i is make_sequence(scenario, seed, i), as in `simulate`, so that a run over DDS can be compared
// with one without. No network was trained on it: training draws its sequences from 64-bit hashes of its
// seed.
void run_sequences(const FrameRenderer& renderer, const std::vector<std::uint8_t>& model,
                   const TemplateMatcher* matcher, const MonteCarloSettings& settings,
                   const std::vector<std::uint32_t>& indices, const SequenceSink& take,
                   const std::function<void(std::uint32_t)>& progress);

struct MonteCarloResult {
  std::vector<FrameResult> frames;  // ordered by sequence and frame; lost frames have none
  double step_ms = 0.0;             // median over the sequences of the mean time per frame, one thread
  double baseline_ms = 0.0;         // median time per frame of the baseline; 0 if it was not run
};

// The results of the sequences 0 to n - 1, in any order, each once. Estimates become the nearest attitude
// that looks the same.
MonteCarloResult joined(std::vector<SequenceResult> results, const TargetSymmetry& symmetry);

// Runs all sequences of the settings and joins their results.
MonteCarloResult run_monte_carlo(const FrameRenderer& renderer, const std::vector<std::uint8_t>& model,
                                 const TemplateMatcher* matcher, const MonteCarloSettings& settings,
                                 const std::function<void(std::uint32_t)>& progress);

}  // namespace tumblesight::sim
