// Record: the figures of a shipped model as `tumblesight evaluate --json` wrote them, kept beside its image,
// and the question whether a shorter run is worse than they allow.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/evaluation/metrics.hpp"
#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::sim {

// One row of the file. Its summaries lack the median and the share within 5 degrees.
struct Record {
  std::string target;
  std::string mesh;
  std::uint32_t model_crc32 = 0;
  Condition condition = Condition::kNominal;
  std::uint32_t frames = 0;
  std::uint64_t seed = 0;
  ErrorSummary rcnn;
  ErrorSummary cnn;
};

// `json`: the file's text; `name`: the file's, for messages. Throws std::runtime_error that names the file
// and what is missing or wrong in it.
std::vector<Record> read_records(const std::string& json, const std::string& name);

// What a run may be above the recorded mean, or below the recorded share within 20 degrees: three standard
// errors of the difference of two independent runs, the recorded one and one of `count` sequences.
double mean_tolerance_deg(const ErrorSummary& recorded, std::size_t count);
double share_tolerance(const ErrorSummary& recorded, std::size_t count);
// Empty if `run` is as good as `recorded` within these; otherwise what is worse, with both figures.
std::string worse_than(const ErrorSummary& recorded, const ErrorSummary& run);

}  // namespace tumblesight::sim
