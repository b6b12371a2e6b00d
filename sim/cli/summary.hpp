// The figures of a run as terminal tables and as JSON; `simulate` and `evaluate` show them alike.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sim/evaluation/metrics.hpp"
#include "sim/evaluation/paper.hpp"

namespace tumblesight::sim {

// {"mean_deg", "median_deg", "within_20deg", "within_5deg"}; null without a sequence that got to its last
// frame.
nlohmann::ordered_json summary_json(const ErrorSummary& summary);

// Last frame, RCNN and CNN, beside the paper's figures where there are some.
std::string headline_table(const std::vector<FrameResult>& results, std::uint32_t frames,
                           const PaperFigures& paper);
// Mean and median of RCNN and CNN, a column a frame; of more than ten frames a selection that ends in the
// last.
std::string by_frame_table(const std::vector<FrameResult>& results, std::uint32_t frames);

}  // namespace tumblesight::sim
