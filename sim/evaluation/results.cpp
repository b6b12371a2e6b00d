#include "sim/evaluation/results.hpp"

#include <fmt/format.h>

#include "sim/evaluation/chance.hpp"

namespace tumblesight::sim {

bool differs_from_paper(const CellResult& cell) {
  return !differences_from_paper(cell).empty();
}

std::string differences_from_paper(const CellResult& cell) {
  std::string text;
  if (!cell.sensor.is_the_papers()) text += ", sensor " + cell.sensor.name;
  if (!cell.ranges.are_the_papers()) text += ", " + to_string(cell.ranges);
  const std::string effects = to_string(cell.effects);
  if (!effects.empty()) text += ", " + effects;
  if (!cell.symmetry.is_none()) text += ", modulo " + to_string(cell.symmetry);
  return text.empty() ? text : text.substr(2);
}

PaperFigures paper_figures(const std::string& target, const CellResult& cell) {
  if (differs_from_paper(cell)) return {};
  return paper_figures(target, cell.condition, cell.disturbances);
}

bool is_mostly_wrong(const CellResult& cell) {
  return is_mostly_wrong(cell.rcnn) && show_the_target(cell.effects);
}

const CellResult* cell_of(const SubjectResult& subject, Condition condition) {
  for (const CellResult& cell : subject.cells) {
    if (cell.condition == condition) return &cell;
  }
  return nullptr;
}

std::vector<DetectionPoint> detection_of(const SubjectResult& subject) {
  std::vector<DetectionPoint> sum;
  for (const CellResult& cell : subject.cells) add(sum, cell.detection);
  return sum;
}

std::string title_of(const SubjectResult& subject) {
  const bool own_model = subject.model == subject.target;
  const std::string rule = subject.model == subject.target + "_paper_rule"
                               ? ", trained as in the paper"
                               : fmt::format(", model {}", subject.model);
  const std::string mesh = subject.mesh == kParametricMesh ? "parametric mesh" : subject.mesh;
  const std::string variant = subject.variant.empty() ? "" : ", " + subject.variant;
  return fmt::format("{}, {}{}{}", display_name(subject.target), mesh, own_model ? "" : rule, variant);
}

}  // namespace tumblesight::sim
