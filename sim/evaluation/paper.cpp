#include "sim/evaluation/paper.hpp"

namespace tumblesight::sim {

PaperFigures paper_figures(const std::string& target, Condition condition) {
  const bool nominal = condition == Condition::kNominal;
  if (!nominal && condition != Condition::kDegraded) return {};
  if (target == "near_shoemaker") {
    if (nominal) return {PaperFigure{12.69, 0.88}, PaperFigure{40.94, 0.45}};
    return {PaperFigure{14.09, 0.84}, std::nullopt};
  }
  if (target == "magellan") {
    if (nominal) return {PaperFigure{3.99, 0.99}, PaperFigure{6.36, 0.94}};
    return {PaperFigure{4.57, 1.00}, std::nullopt};
  }
  if (target == "sacd_aquarius") {
    if (nominal) return {PaperFigure{3.09, 1.00}, PaperFigure{5.31, 0.95}};
    return {PaperFigure{3.86, 1.00}, std::nullopt};
  }
  return {};
}

}  // namespace tumblesight::sim
