// Experiment: the paper's tables and curves for one network on one mesh.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/evaluation/results.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// What is measured.
struct Subject {
  std::string target;  // key
  std::string mesh_name;
  TriangleMesh mesh;  // rendered for the frames and for the templates of the baseline
  double swath_m = 0.0;
  std::string model_name;
  std::uint32_t model_crc32 = 0;
  std::vector<std::uint8_t> model;               // an image that AttitudeEstimator::load accepts
  std::optional<Eigen::Matrix3d> inertia_kg_m2;  // in the TRF
  SensorDescription sensor{};                    // that sees it
  RangeLimits ranges{};                          // at which it is seen
  TargetSymmetry symmetry{};                     // of its surface
};

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
  bool peers = false;                      // run the peers of this build on the frames of the baseline
  bool curves = false;                     // run the sweeps too
  bool disturbed_runs = false;             // run disturbed_runs() too
  bool sensor_runs = false;                // run sensor_runs() too, with the paper's sensor
  int threads = 1;
};

// The size of an experiment in steps of about equal duration: one per frame, kStepsPerMatch per match of the
// baseline, and kStepsPerPeer per match of a peer.
inline constexpr std::uint64_t kStepsPerMatch = 100;
inline constexpr std::uint64_t kStepsPerPeer = 1000;
std::uint64_t steps_of(const ExperimentSettings& settings);

// Runs cell after cell. `progress`: steps done so far, out of steps_of(settings); called on the calling
// thread. Throws std::invalid_argument if the model is refused, an inertia is missing or there are no
// conditions, or as require_possible() and observed_bodies() do.
SubjectResult run_experiment(const Subject& subject, const ExperimentSettings& settings,
                             const std::function<void(std::uint64_t)>& progress);

}  // namespace tumblesight::sim
