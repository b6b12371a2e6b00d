// Reliability: whether the expected error that the network gives with its estimate is correct, and whether it
// detects wrong attitudes.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/evaluation/metrics.hpp"

namespace tumblesight::sim {

inline constexpr std::size_t kReliabilityBins = 10;

struct ReliabilityBin {
  double predicted_deg = 0.0;  // mean
  ErrorSummary real;
};

// The RCNN's estimates in ascending order of their expected error, divided into kReliabilityBins parts of
// equal count (fewer if there are fewer estimates). Frames without an estimate are left out: they have no
// expected error.
std::vector<ReliabilityBin> reliability(const std::vector<FrameResult>& results);

// The effect of rejecting every estimate with an expected error above a threshold.
struct DetectionPoint {
  double threshold_deg = 0.0;
  std::size_t wrong = 0;          // wrong estimates
  std::size_t wrong_flagged = 0;  // wrong estimates that are rejected
  std::size_t right = 0;
  std::size_t right_flagged = 0;  // right estimates that are rejected

  double detected() const;          // share 0..1 of the wrong estimates that is rejected; 1 if there are none
  double false_alarms() const;      // share 0..1 of the right estimates that is rejected; 0 if there are none
  double wrong_among_kept() const;  // share 0..1 of the accepted estimates that is wrong; 0 if there are none
};

const std::vector<double>& detection_thresholds_deg();
// One point per threshold.
std::vector<DetectionPoint> detection(const std::vector<FrameResult>& results);
// Adds the counts of `more` per threshold. An empty `sum` becomes `more`.
void add(std::vector<DetectionPoint>& sum, const std::vector<DetectionPoint>& more);

}  // namespace tumblesight::sim
