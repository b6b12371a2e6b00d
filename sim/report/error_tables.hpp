// Tables of the errors of one run, as data. Those of whole results: results_tables.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/evaluation/curves.hpp"
#include "sim/report/error_columns.hpp"

namespace tumblesight::sim {

// The errors of one estimator, and the paper's figure for it.
struct EstimatorErrors {
  std::string name;
  Mark mark = Mark::kNone;
  ErrorSummary summary;
  std::optional<PaperFigure> paper;
};
// One line per estimator with every figure and the number of sequences, below it the paper's.
DataTable estimators_table(const std::vector<EstimatorErrors>& estimators, std::uint32_t paper_sequences);
// The registered poses of the first and the last frames of sequences.
struct NamedPoses {
  std::string name;
  PoseSummary first;
  PoseSummary last;
};
// A line per entry whose last frames have poses.
DataTable poses_table(const std::vector<NamedPoses>& poses);
// Mean and median of RCNN and CNN, a column per frame; of more than ten frames a selection that ends with the
// last.
DataTable by_frame_table(const Curve& by_frame);

}  // namespace tumblesight::sim
