// Curves: the error over what it may depend on, and how it is distributed.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sim/evaluation/metrics.hpp"

namespace tumblesight::sim {

struct CurvePoint {
  double at = 0.0;  // frame number from 1, or the middle of a bin
  ErrorSummary rcnn;
  ErrorSummary cnn;
};
using Curve = std::vector<CurvePoint>;

CurvePoint curve_point(double at, const std::vector<FrameResult>& results);

// One point a frame number 1 .. frames.
Curve errors_by_frame(const std::vector<FrameResult>& results, std::uint32_t frames);

// One point for each bin between two neighbouring `edges` (ascending): the lower edge belongs to it, the
// upper one to the next bin, but the last edge to the last bin. Results beyond the edges count nowhere; a bin
// without results has count 0.
Curve binned(const std::vector<FrameResult>& results,
             const std::function<double(const FrameResult&)>& value_of, const std::vector<double>& edges);

// The paper's bins: 20..100 m by 10, 0..20 deg/s by 2.5. `last`: last frames.
Curve errors_by_range(const std::vector<FrameResult>& last);
Curve errors_by_rate(const std::vector<FrameResult>& last);

// Largest over smallest mean error of the RCNN among bins that hold at least `least` sequences; 0 when there
// are fewer than two such bins.
double flatness(const Curve& curve, std::size_t least = 30);

// Upper limits of the histogram's bins [deg]; the first bin starts at 0.
const std::vector<double>& histogram_limits_deg();
// Share of the errors (0..1) in each bin, its upper limit included.
std::vector<double> histogram(const std::vector<double>& errors_deg);

}  // namespace tumblesight::sim
