#include "sim/evaluation/reliability.hpp"

#include <algorithm>
#include <utility>

#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

double share(std::size_t part, std::size_t all, double if_none) {
  return all == 0 ? if_none : static_cast<double>(part) / static_cast<double>(all);
}

}  // namespace

std::vector<ReliabilityBin> reliability(const std::vector<FrameResult>& results) {
  std::vector<std::pair<double, double>> estimates;  // predicted, real
  for (const FrameResult& result : results) {
    if (!result.valid) continue;
    estimates.emplace_back(kDegPerRad * result.rcnn_predicted_rad, error_deg(result, Estimator::kRcnn));
  }
  std::sort(estimates.begin(), estimates.end());
  const std::size_t bins = std::min(kReliabilityBins, estimates.size());
  std::vector<ReliabilityBin> found;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    const std::size_t from = bin * estimates.size() / bins;
    const std::size_t to = (bin + 1) * estimates.size() / bins;
    ReliabilityBin entry;
    std::vector<double> real;
    for (std::size_t i = from; i < to; ++i) {
      entry.predicted_deg += estimates[i].first / static_cast<double>(to - from);
      real.push_back(estimates[i].second);
    }
    entry.real = summarise(std::move(real));
    found.push_back(entry);
  }
  return found;
}

double DetectionPoint::detected() const {
  return share(wrong_flagged, wrong, 1.0);
}

double DetectionPoint::false_alarms() const {
  return share(right_flagged, right, 0.0);
}

double DetectionPoint::wrong_among_kept() const {
  const std::size_t wrong_kept = wrong - wrong_flagged;
  return share(wrong_kept, wrong_kept + right - right_flagged, 0.0);
}

const std::vector<double>& detection_thresholds_deg() {
  static const std::vector<double> thresholds{1, 2, 3, 5, 7, 10, 15, 20, 30, 45, 60, 90};
  return thresholds;
}

std::vector<DetectionPoint> detection(const std::vector<FrameResult>& results) {
  std::vector<DetectionPoint> points;
  for (const double threshold_deg : detection_thresholds_deg()) {
    DetectionPoint point;
    point.threshold_deg = threshold_deg;
    for (const FrameResult& result : results) {
      if (!result.valid) continue;
      const bool flagged = kDegPerRad * result.rcnn_predicted_rad > threshold_deg;
      const bool is_wrong = error_deg(result, Estimator::kRcnn) > kWrong_deg;
      ++(is_wrong ? point.wrong : point.right);
      if (flagged) ++(is_wrong ? point.wrong_flagged : point.right_flagged);
    }
    points.push_back(point);
  }
  return points;
}

void add(std::vector<DetectionPoint>& sum, const std::vector<DetectionPoint>& more) {
  if (sum.empty()) {
    sum = more;
    return;
  }
  for (std::size_t i = 0; i < sum.size() && i < more.size(); ++i) {
    sum[i].wrong += more[i].wrong;
    sum[i].wrong_flagged += more[i].wrong_flagged;
    sum[i].right += more[i].right;
    sum[i].right_flagged += more[i].right_flagged;
  }
}

}  // namespace tumblesight::sim
