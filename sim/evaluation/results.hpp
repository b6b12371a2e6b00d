// Results: every figure of an experiment. Tables, files and reports are made from it alone.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/evaluation/confusion.hpp"
#include "sim/evaluation/curves.hpp"
#include "sim/evaluation/paper.hpp"
#include "sim/evaluation/rare_events.hpp"
#include "sim/evaluation/reliability.hpp"
#include "sim/evaluation/run_conditions.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {

// The figures of one condition: of last frames unless stated otherwise.
struct CellResult : RunConditions {
  Condition condition = Condition::kNominal;
  std::uint32_t sequences = 0;
  std::uint32_t frames = 0;  // per sequence
  ErrorSummary rcnn;
  ErrorSummary cnn;
  PoseSummary pose;                     // registered
  PoseSummary pose_first;               // of the first frames
  double never_valid_from_fifth = 0.0;  // share of the sequences without a valid frame from the fifth on
  CommonTurn common_turn;               // of the RCNN
  RareEvents rare;
  std::string replay;  // the command that shows a sequence, up to its index; empty: not known
  std::optional<ErrorSummary> baseline;  // over the first sequences only, see its count
  double step_ms = 0.0;                  // per frame, one thread
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

// Further runs, made under the condition `base`.
struct Sweeps {
  Condition base = Condition::kNominal;
  Curve by_rate_norm;                 // RateDistribution::kNorm; cells use kComponents
  Curve by_hidden_share;              // at: share 0..1 of the target's returns that is hidden
  Curve long_run;                     // by frame
  std::uint32_t sweep_sequences = 0;  // per hidden share
  std::uint32_t long_sequences = 0;
};

// One network on one mesh.
struct SubjectResult {
  std::string target;  // key
  std::string mesh;    // kParametricMesh, or the name of the file, with its folder where names are equal
  std::string model;   // file name without its extension
  std::uint32_t model_crc32 = 0;
  std::vector<CellResult> cells;
  std::optional<Sweeps> sweeps;
  std::vector<CellResult> disturbed;    // disturbed_runs(), or none
  std::vector<CellResult> sensor_runs;  // sensor_runs() of pose_goals.hpp, or none
  std::string variant{};                // tells it from a subject with the same names; empty: not needed
};

struct Results {
  std::uint64_t seed = 0;
  std::string command;             // reproduces them
  std::string generated;           // date and time, as text
  std::vector<std::string> notes;  // what is missing, and why
  std::vector<SubjectResult> subjects;
};

// Whether effects, another sensor or other ranges than the paper's make the frames of a cell, or its errors
// are modulo a symmetry.
bool differs_from_paper(const CellResult& cell);
// What differs, "sensor flash_256, 50 to 200 m, noise=2"; empty for the paper's.
std::string differences_from_paper(const CellResult& cell);
// The paper's figures for a cell, see paper_figures(). None for one that differs from it in this way.
PaperFigures paper_figures(const std::string& target, const CellResult& cell);
// More than half of the attitudes in the last frame are wrong, and the frames show the target.
bool is_mostly_wrong(const CellResult& cell);
// The figures of one condition, or nullptr if it was not run.
const CellResult* cell_of(const SubjectResult& subject, Condition condition);
// Detection, summed over all conditions of a subject.
std::vector<DetectionPoint> detection_of(const SubjectResult& subject);

// "NEAR Shoemaker, parametric mesh" or "NEAR Shoemaker, near.stl". A model that is not the target's own is
// named too, and so is the variant.
std::string title_of(const SubjectResult& subject);

}  // namespace tumblesight::sim
