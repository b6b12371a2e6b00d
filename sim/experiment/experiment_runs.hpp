// Experiment runs: what an experiment consists of. A run is a number of sequences in one scenario; the
// figures of a cell, or the points of a curve, are made from one or more of them.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::sim {

struct ExperimentSettings {
  std::vector<Condition> conditions{
      Condition::kNominal};  // one cell each; the first one is the base of the curves
  std::uint64_t seed = 1;
  std::uint32_t sequences = 900;
  std::uint32_t tumbling_sequences = 900;
  std::uint32_t frames = kFramesPerSequence;
  Disturbances disturbances;               // of every run, those of the curves too
  Effects effects;                         // likewise
  std::uint32_t baseline_sequences = 100;  // per cell; 0: no baseline
  bool curves = false;                     // run the sweeps too
  bool disturbed_runs = false;             // run disturbed_runs() too
  bool sensor_runs = false;                // run sensor_runs() too, with the paper's sensor
  int threads = 1;                         // the figures do not depend on it
};

struct ExperimentRun {
  enum class Kind { kCell, kRateNorm, kHiddenShare, kLong, kDisturbed, kSensor };
  Kind kind = Kind::kCell;
  // Without what belongs to the subject: inertia, sensor and swath, and ranges but those of kSensor.
  ScenarioSettings scenario;
  std::uint32_t sequences = 0;
  std::uint32_t baseline_sequences = 0;
};

// In a fixed order: cells, sweeps, disturbed runs, sensor runs. Throws std::invalid_argument if there are no
// conditions.
std::vector<ExperimentRun> runs_of(const ExperimentSettings& settings);

// The size of an experiment in steps of about equal duration: one per frame, and kStepsPerMatch per match
// of the baseline.
inline constexpr std::uint64_t kStepsPerMatch = 100;
std::uint64_t steps_of(const ExperimentRun& run, std::uint32_t sequences_done);
std::uint64_t steps_of(const ExperimentSettings& settings);

}  // namespace tumblesight::sim
