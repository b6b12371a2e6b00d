// Results: every figure of an experiment, and nothing else: what tables, files and reports are made from.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/evaluation/confusion.hpp"
#include "sim/evaluation/curves.hpp"
#include "sim/evaluation/paper.hpp"
#include "sim/evaluation/reliability.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/target/target_mesh.hpp"

namespace tumblesight::sim {

// One condition, last frames unless said otherwise.
struct CellResult {
  Condition condition = Condition::kNominal;
  std::uint32_t sequences = 0;
  std::uint32_t frames = 0;  // a sequence
  ErrorSummary rcnn;
  ErrorSummary cnn;
  std::optional<ErrorSummary> baseline;  // over the first sequences only: see its count
  double network_ms = 0.0;               // a frame, one thread
  double baseline_ms = 0.0;
  Curve by_frame;
  Curve by_range;
  Curve by_rate;
  std::vector<double> rcnn_histogram;
  std::vector<double> cnn_histogram;
  std::vector<double> baseline_histogram;  // empty without baseline
  Confusion rcnn_confusion;
  Confusion cnn_confusion;
  std::vector<ReliabilityBin> reliability;  // every frame
  std::vector<DetectionPoint> detection;    // every frame
};

// Runs beside the conditions: `base` is the condition they are made under.
struct Sweeps {
  Condition base = Condition::kNominal;
  Curve by_rate_norm;                 // rates drawn by their norm; cells draw them by components
  Curve by_hidden_share;              // at: share 0..1 of the target's returns that an occluder hides
  Curve long_run;                     // by frame
  std::uint32_t sweep_sequences = 0;  // of each hidden share
  std::uint32_t long_sequences = 0;
};

// One network on one mesh.
struct SubjectResult {
  std::string target;
  std::string mesh;   // kParametricMesh or the name of the file
  std::string model;  // file name without its ending
  std::uint32_t model_crc32 = 0;
  std::vector<CellResult> cells;
  std::optional<Sweeps> sweeps;
};

struct Results {
  std::uint64_t seed = 0;
  std::string command;             // that makes them again
  std::string generated;           // when, for the reader
  std::vector<std::string> notes;  // what is missing, and why
  std::vector<SubjectResult> subjects;
};

// The figure of one condition, or nullptr when it was not run.
const CellResult* cell_of(const SubjectResult& subject, Condition condition);
// Detection over all conditions of a subject.
std::vector<DetectionPoint> detection_of(const SubjectResult& subject);

// "NEAR Shoemaker" for "near_shoemaker"; a target that does not ship keeps its own name.
std::string display_name(const std::string& target);
// "NEAR Shoemaker, parametric mesh" or "NEAR Shoemaker, near.stl"; a model that is not the target's own is
// named as well.
std::string title_of(const SubjectResult& subject);

}  // namespace tumblesight::sim
