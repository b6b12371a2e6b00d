#include "sim/quantization/distribution.hpp"

#include <algorithm>
#include <cmath>

namespace tumblesight::sim {
namespace {

constexpr double kBinsPerOctave = 32.0;

}  // namespace

void Distribution::add(double value) {
  count_ += 1.0;
  if (!(value > 0.0)) return;
  largest_ = std::max(largest_, value);
  counts_[static_cast<int>(std::floor(kBinsPerOctave * std::log2(value)))] += 1.0;
}

double Distribution::squared_loss(double unit, double largest_integer) const {
  double sum = 0.0;
  for (const auto& [bin, count] : counts_) {
    const double value = std::exp2((bin + 0.5) / kBinsPerOctave);
    const double beyond = value - unit * largest_integer;
    const double rounding = value < 0.5 * unit ? value * value : unit * unit / 12.0;
    sum += count * (beyond > 0.0 ? beyond * beyond : rounding);
  }
  return sum / std::max(1.0, count_);
}

}  // namespace tumblesight::sim
