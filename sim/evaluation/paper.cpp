#include "sim/evaluation/paper.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

constexpr PaperFigure kNotPublished{-1.0, 0.0};

struct Row {
  const char* target;  // Mission::paper_target
  Condition condition;
  PaperFigure rcnn;
  PaperFigure cnn = kNotPublished;
};

constexpr Row kRows[] = {
    {"near_shoemaker", Condition::kNominal, {12.69, 0.88}, {40.94, 0.45}},
    {"near_shoemaker", Condition::kDegraded, {14.09, 0.84}},
    {"near_shoemaker", Condition::kOccluded, {22.86, 0.64}},
    {"near_shoemaker", Condition::kTumbling, {13.16, 0.85}},
    {"near_shoemaker", Condition::kStress, {17.21, 0.74}},
    {"magellan", Condition::kNominal, {3.99, 0.99}, {6.36, 0.94}},
    {"magellan", Condition::kDegraded, {4.57, 1.00}},
    {"magellan", Condition::kOccluded, {13.89, 0.83}},
    {"magellan", Condition::kTumbling, {4.86, 0.99}},
    {"sacd_aquarius", Condition::kNominal, {3.09, 1.00}, {5.31, 0.95}},
    {"sacd_aquarius", Condition::kDegraded, {3.86, 1.00}},
    {"sacd_aquarius", Condition::kOccluded, {12.82, 0.86}},
    {"sacd_aquarius", Condition::kTumbling, {3.97, 0.99}},
};

}  // namespace

PaperFigures paper_figures(const std::string& target, Condition condition, const Disturbances& disturbances) {
  if (!given_disturbances(disturbances).empty()) return {};
  const Mission* mission = find_target(target);
  if (mission == nullptr || mission->paper_target.empty()) return {};
  const auto* row = std::find_if(std::begin(kRows), std::end(kRows), [&](const Row& r) {
    return std::string_view(r.target) == mission->paper_target && r.condition == condition;
  });
  if (row == std::end(kRows)) return {};
  PaperFigures figures;
  figures.rcnn = row->rcnn;
  if (condition == Condition::kTumbling) figures.sequences = kPaperTumblingSequences;
  if (row->cnn.mean_deg >= 0.0) figures.cnn = row->cnn;
  return figures;
}

}  // namespace tumblesight::sim
