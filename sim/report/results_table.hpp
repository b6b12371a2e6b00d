// Results as tables for a terminal.
#pragma once

#include <string>
#include <vector>

#include "sim/evaluation/results.hpp"

namespace tumblesight::sim {

// "6.92 ± 0.40°"; of one sequence "6.92°", since its error cannot be known; "-" without any.
std::string mean_text(const ErrorSummary& summary);
// "97.2 ± 0.5 %", or "-"
std::string within_20deg_text(const ErrorSummary& summary);
// "12.69°, 88 %", or "-"; a goal's share keeps its decimals.
std::string figure_text(const std::optional<PaperFigure>& figure);

// One condition in full: each estimator's figures, the paper's below them.
std::string cell_table(const ErrorSummary& rcnn, const ErrorSummary& cnn,
                       const std::optional<ErrorSummary>& baseline, std::uint32_t frames,
                       const PaperFigures& paper);
// Mean and median of RCNN and CNN, a column a frame; of more than ten frames a selection that ends in the
// last.
std::string by_frame_table(const Curve& by_frame);
// A line a point with sequences: their number, RCNN and CNN. `at`: what the curve runs over.
std::string curve_table(const std::string& at, const Curve& curve);
// A line a subject and condition, the paper's figure and the goal beside ours.
std::string overview_table(const Results& results);

}  // namespace tumblesight::sim
