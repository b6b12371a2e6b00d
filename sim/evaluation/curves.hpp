// Curves: the error as a function of frame number, range or rate, and its distribution; and the strength of
// an effect up to which the attitudes stay good enough.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "sim/evaluation/metrics.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/sensor/effects.hpp"

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

// The share of sequences that has to be within 20 degrees in the last frame.
inline constexpr double kEffectBar = 0.95;

// One side of an effect: the strengths from one end to the other.
struct EffectLimit {
  struct Trial {
    double strength = 0.0;
    double within_20deg = 0.0;
  };
  double from = 0.0;  // 0: without the effect
  double to = 0.0;
  // The neighbouring strengths of which the first meets kEffectBar and the second does not. Without the first
  // neither end meets it, without the second both do, and holds_at is `to`.
  std::optional<double> holds_at{};
  std::optional<double> fails_at{};
  std::vector<Trial> trials{};  // in their order
};
// Bisection over the strengths of the row, which need not become harder upwards; an effect with negative
// strengths has two sides, each from 0. `within_20deg`: the share at a strength. The two strengths of a limit
// are at most 5 % apart where the range spans a factor of more than 20, otherwise 1 % of the range, or one
// whole number. Strengths in between have three digits.
std::vector<EffectLimit> effect_limits(const EffectRow& row,
                                       const std::function<double(double)>& within_20deg);

}  // namespace tumblesight::sim
