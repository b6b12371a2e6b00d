// Disturbed runs: the disturbances under which `evaluate --paper` measures a network, and what it must still
// reach.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/evaluation/results.hpp"

namespace tumblesight::sim {

// What the attitudes of the network must reach, compared with those of the undisturbed run on the same
// sequences. A limit that is not given does not apply. Shares are 0..1.
struct DisturbedBar {
  std::optional<double> most_times_the_mean{};      // of the errors within 20 degrees
  std::optional<double> most_fewer_within_20deg{};  // of all sequences
  std::optional<double> least_right_and_valid{};    // itself
  bool not_more_wrong_and_valid = false;
};

struct DisturbedRun {
  Condition condition = Condition::kNominal;
  Disturbances disturbances;
  DisturbedBar bar;
};

// In the order of tables and files.
const std::vector<DisturbedRun>& disturbed_runs();

// The run that `cell` is of, or nullptr if it is none of disturbed_runs().
const DisturbedRun* disturbed_run_of(const CellResult& cell);

// Whether the RCNN of `cell` meets the bar. `undisturbed`: the cell of the same condition, or nullptr;
// without it a comparison with it is not met.
bool meets(const DisturbedBar& bar, const CellResult& cell, const CellResult* undisturbed);
// "1.15 times the mean, 0.2 % fewer within 20°"; empty without a bar.
std::string text_of(const DisturbedBar& bar);

}  // namespace tumblesight::sim
