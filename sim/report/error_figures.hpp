// Figures of errors, as inline SVG: what the reports of single runs and of whole experiments have in common,
// and what the latter need beside it. Empty text where there is nothing to show.
#pragma once

#include <string>
#include <vector>

#include "sim/evaluation/confusion.hpp"
#include "sim/evaluation/curves.hpp"
#include "sim/evaluation/reliability.hpp"
#include "sim/report/charts.hpp"

namespace tumblesight::sim {

// The mean error of one estimator as a line; points without sequences are left out. `bars`: one standard
// error to either side.
Series mean_series(const std::string& name, const std::string& colour, const Curve& curve,
                   Estimator estimator, bool bars);

// Shares 0..1 as histogram() gives them; an estimator without any is left out.
std::string histogram_figure(const std::vector<double>& rcnn, const std::vector<double>& cnn,
                             const std::vector<double>& baseline);

template <typename T>
struct Named {
  std::string name;
  std::string colour;
  T figures;
};

// A row each; all must be of the same symmetries.
std::string confusion_figure(const std::vector<Named<Confusion>>& rows);
std::string reliability_figure(const std::vector<Named<std::vector<ReliabilityBin>>>& lines);
std::string detection_figure(const std::vector<DetectionPoint>& points);

}  // namespace tumblesight::sim
