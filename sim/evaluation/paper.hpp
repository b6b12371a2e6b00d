// The paper's results (DOI 10.1016/j.conengprac.2026.107134) and the goals of this project, for comparison
// with measured figures.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sim/world/scenario/condition.hpp"
#include "sim/world/scenario/disturbance.hpp"

namespace tumblesight::sim {

inline constexpr std::uint32_t kPaperSequences = 900;
inline constexpr std::uint32_t kPaperTumblingSequences = 1000;

// Error of the last frame.
struct PaperFigure {
  double mean_deg = 0.0;
  double within_20deg = 0.0;  // share 0..1
};

struct PaperFigures {
  std::optional<PaperFigure> rcnn;
  std::optional<PaperFigure> cnn;  // published for the nominal condition only
  std::uint32_t sequences = kPaperSequences;
};

// Empty if the paper has no figures for this target (Mission::paper_target) and condition. It has none for a
// disturbed run.
PaperFigures paper_figures(const std::string& target, Condition condition,
                           const Disturbances& disturbances = {});

}  // namespace tumblesight::sim
