// Reliability: is the error that the network predicts for itself right, and does it tell when the attitude is
// wrong?
#pragma once

#include <cstddef>
#include <vector>

#include "sim/evaluation/metrics.hpp"

namespace tumblesight::sim {

inline constexpr double kWrong_deg = 20.0;  // an attitude farther off is wrong (the paper's limit of success)
inline constexpr std::size_t kReliabilityBins = 10;

struct ReliabilityBin {
  double predicted_deg = 0.0;  // mean
  ErrorSummary real;
};

// The RCNN's estimates in ascending order of their predicted error, cut into kReliabilityBins parts of equal
// count (fewer when there are fewer estimates). Estimates that were not given are left out: no error was
// predicted.
std::vector<ReliabilityBin> reliability(const std::vector<FrameResult>& results);

// What a consumer does who throws away estimates with a predicted error above a threshold.
struct DetectionPoint {
  double threshold_deg = 0.0;
  std::size_t wrong = 0;          // estimates that are wrong
  std::size_t wrong_flagged = 0;  // of these, thrown away
  std::size_t right = 0;
  std::size_t right_flagged = 0;  // thrown away for nothing

  double detected() const;      // share 0..1 of the wrong ones; 1 when there are none
  double false_alarms() const;  // share 0..1 of the right ones
  double wrong_among_kept() const;
};

const std::vector<double>& detection_thresholds_deg();
// One point a threshold.
std::vector<DetectionPoint> detection(const std::vector<FrameResult>& results);
// Adds the counts of `more`, threshold by threshold; to nothing gives `more`.
void add(std::vector<DetectionPoint>& sum, const std::vector<DetectionPoint>& more);

}  // namespace tumblesight::sim
