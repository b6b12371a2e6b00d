// Figures of angular errors as inline SVG, for the pages of runs and of experiments. Empty text where there
// is nothing to show.
#pragma once

#include <string>
#include <vector>

#include "sim/evaluation/confusion.hpp"
#include "sim/evaluation/curves.hpp"
#include "sim/evaluation/reliability.hpp"
#include "sim/report/charts.hpp"

namespace tumblesight::sim {

// The mean error of one estimator as a line; points without sequences are left out. `bars`: with error bars
// of one standard error.
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

// One row each; all must have the same symmetries.
std::string confusion_figure(const std::vector<Named<Confusion>>& rows);
std::string reliability_figure(const std::vector<Named<std::vector<ReliabilityBin>>>& lines);
std::string detection_figure(const std::vector<DetectionPoint>& points);

}  // namespace tumblesight::sim
