// Figures to stand beside ours: the paper's (DOI 10.1016/j.conengprac.2026.107134, results) and the goals
// this project set itself.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::sim {

inline constexpr std::uint32_t kPaperSequences = 900;
inline constexpr std::uint32_t kPaperTumblingSequences = 1000;

// Error of the last frame.
struct PaperFigure {
  double mean_deg = 0.0;
  double within_20deg = 0.0;  // 0..1
};

struct PaperFigures {
  std::optional<PaperFigure> rcnn;
  std::optional<PaperFigure> cnn;   // published for the nominal condition only
  std::optional<PaperFigure> goal;  // of the RCNN: at most this mean, at least this share
  std::uint32_t sequences = kPaperSequences;
};

// Empty figures where the paper has none for this target and condition. The paper's Aquarius stands beside
// both of ours, stowed and deployed.
PaperFigures paper_figures(const std::string& target, Condition condition);

// What is run for the paper's tables: its own conditions, then those beyond it; stress for NEAR only.
std::vector<Condition> paper_conditions(const std::string& target);

}  // namespace tumblesight::sim
