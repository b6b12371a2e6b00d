// Distribution: histogram of one channel's outputs, and the loss when they are quantized.
#pragma once

#include <map>

namespace tumblesight::sim {

class Distribution {
 public:
  void add(double value);                      // >= 0
  double largest() const { return largest_; }  // 0 if there are no values
  // Mean square error when values are rounded to multiples of `unit` and clamped to `largest_integer` units.
  double squared_loss(double unit, double largest_integer) const;

 private:
  double count_ = 0.0;
  double largest_ = 0.0;
  std::map<int, double> counts_;  // by bin on a logarithmic scale; zeros are not in it
};

}  // namespace tumblesight::sim
