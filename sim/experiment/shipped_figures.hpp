// ShippedFigures: the accuracy of a shipped model as `tumblesight evaluate --json` wrote it to <model>.json
// beside its image, and the decision whether a shorter run is significantly worse.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/evaluation/metrics.hpp"
#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::sim {

// One row of the file: one condition. The summaries lack the median and the share within 5 degrees.
struct ShippedFigures {
  std::string target;
  std::string mesh;
  std::uint32_t model_crc32 = 0;
  Condition condition = Condition::kNominal;
  std::uint32_t frames = 0;  // per sequence
  std::uint64_t seed = 0;
  ErrorSummary rcnn;
  ErrorSummary cnn;
};

// The rows of a file. `json`: its text; `name`: its name, for messages. Throws std::runtime_error that names
// the file and what is missing or wrong in it.
std::vector<ShippedFigures> read_shipped_figures(const std::string& json, const std::string& name);

// By how much a run of `count` sequences may exceed the shipped mean, or fall below the shipped share within
// 20 degrees: three standard errors of the difference of two independent runs.
double mean_tolerance_deg(const ErrorSummary& shipped, std::size_t count);
double share_tolerance(const ErrorSummary& shipped, std::size_t count);
// Empty if `run` is as good as `shipped` within these tolerances. Otherwise what is worse, with both figures.
std::string worse_than(const ErrorSummary& shipped, const ErrorSummary& run);

}  // namespace tumblesight::sim
