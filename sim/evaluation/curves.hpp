// Curves: the error as a function of frame number, range or rate, and its distribution.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sim/evaluation/metrics.hpp"
#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::sim {

struct CurvePoint {
  double at = 0.0;  // frame number from 1, or the centre of a bin
  ErrorSummary rcnn;
  ErrorSummary cnn;
};
using Curve = std::vector<CurvePoint>;

CurvePoint curve_point(double at, const std::vector<FrameResult>& results);

// One point per frame number 1 .. frames, of the estimates that were given or owed.
Curve errors_by_frame(const std::vector<FrameResult>& results, std::uint32_t frames);

// One point per bin between two neighbouring `edges` (ascending). A bin includes its lower edge; the last bin
// includes its upper edge too. Results outside the edges are ignored; a bin without results has count 0.
Curve binned(const std::vector<FrameResult>& results,
             const std::function<double(const FrameResult&)>& value_of, const std::vector<double>& edges);

// Eight bins of equal width: over the ranges (the paper's: 20..100 m in steps of 10 m), and over 0..20 deg/s.
// `last`: last frames.
Curve errors_by_range(const std::vector<FrameResult>& last, const RangeLimits& ranges = {});
Curve errors_by_rate(const std::vector<FrameResult>& last);

// Largest over smallest mean error of the RCNN among bins with at least `min_count` sequences; 0 if there are
// fewer than two such bins.
double flatness(const Curve& curve, std::size_t min_count = 30);

// Upper limits of the histogram's bins [deg]; the first bin starts at 0.
const std::vector<double>& histogram_limits_deg();
// Share 0..1 of the errors in each bin. A bin includes its upper limit.
std::vector<double> histogram(const std::vector<double>& errors_deg);

}  // namespace tumblesight::sim
