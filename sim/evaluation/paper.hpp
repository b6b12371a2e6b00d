// The paper's published figures, to stand beside ours (DOI 10.1016/j.conengprac.2026.107134, results).
#pragma once

#include <optional>
#include <string>

#include "sim/scenario/sequence.hpp"

namespace tumblesight::sim {

// 900 sequences, error of the last frame.
struct PaperFigure {
  double mean_deg = 0.0;
  double within_20deg = 0.0;  // 0..1
};

struct PaperFigures {
  std::optional<PaperFigure> rcnn;
  std::optional<PaperFigure> cnn;  // published for the nominal condition only
};

// Empty figures where the paper has none for this target and condition.
PaperFigures paper_figures(const std::string& target, Condition condition);

}  // namespace tumblesight::sim
