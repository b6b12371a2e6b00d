// Experiment: the paper's tables and curves for one network on one mesh. Its sequences are run first, in any
// order and in as many parts as one likes; the figures are made from their results afterwards.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/evaluation/results.hpp"
#include "sim/experiment/experiment_runs.hpp"
#include "sim/experiment/sequence_result.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// What the figures need to know of the subject that was measured.
struct SubjectDescription {
  std::string target;  // key
  std::string mesh_name;
  double swath_m = 0.0;
  std::string model_name;
  std::uint32_t model_crc32 = 0;
  std::optional<Eigen::Matrix3d> inertia_kg_m2;  // in the TRF
  SensorDescription sensor{};                    // that sees it
  RangeLimits ranges{};                          // at which it is seen
  TargetSymmetry symmetry{};                     // of its surface
};

// What is measured.
struct Subject : SubjectDescription {
  TriangleMesh mesh;                // rendered for the frames and for the templates of the baseline
  std::vector<std::uint8_t> model;  // an image that AttitudeEstimator::load accepts
};

// Sets what replays the sequences of the cells: `command` is that of the evaluation.
void set_replay(SubjectResult& figures, const std::string& command);

// Makes the figures of an experiment from the results of its sequences.
class ExperimentFigures {
 public:
  ExperimentFigures(const SubjectDescription& subject, const ExperimentSettings& settings);

  // Sequences of a run, an index of runs_of(), in any order and each once. The runs in ascending order.
  void add(std::size_t run, SequenceResult&& result);
  // Of the sequences that were added.
  SubjectResult finish();

 private:
  void finish_run();

  const SubjectDescription subject_;
  std::vector<ExperimentRun> runs_;
  std::size_t run_ = 0;
  std::vector<SequenceResult> results_;
  SubjectResult figures_;
};

// The sequences of a run, an index of runs_of(), that are to be run.
using SequenceChoice = std::function<std::vector<std::uint32_t>(std::size_t run, const ExperimentRun&)>;

// Runs the chosen sequences, run after run, and gives each result to `take`, one at a time. `progress`: steps
// done so far, see steps_of(); called on the calling thread. Throws std::invalid_argument if the model is
// refused, an inertia is missing or there are no conditions, or as require_possible() and observed_bodies()
// do.
void run_chosen(const Subject& subject, const ExperimentSettings& settings, const SequenceChoice& choice,
                const std::function<void(std::size_t run, SequenceResult&&)>& take,
                const std::function<void(std::uint64_t)>& progress);

// Runs all sequences and makes the figures. `progress`: steps done so far, out of steps_of(settings).
SubjectResult run_experiment(const Subject& subject, const ExperimentSettings& settings,
                             const std::function<void(std::uint64_t)>& progress);

}  // namespace tumblesight::sim
