// Figures of one network on one mesh, as inline SVG. Empty text where there is nothing to show.
#pragma once

#include <string>

#include "sim/evaluation/results.hpp"

namespace tumblesight::sim {

// Mean error by condition: RCNN, CNN, template matching, the paper's RCNN.
std::string conditions_figure(const SubjectResult& subject);
std::string frames_figure(const SubjectResult& subject);
std::string range_figure(const CellResult& cell);
std::string rate_figure(const SubjectResult& subject);
std::string hidden_share_figure(const Sweeps& sweeps);
std::string long_run_figure(const Sweeps& sweeps);

}  // namespace tumblesight::sim
