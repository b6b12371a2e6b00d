// How often a channel's outputs have which size, and what is lost where they get few bits.
#pragma once

#include <map>

namespace tumblesight::sim {

class Distribution {
 public:
  void add(double value);  // not negative
  double largest() const { return largest_; }
  // Mean square of the change when values are rounded to whole units and held to `largest_integer` units.
  double squared_loss(double unit, double largest_integer) const;

 private:
  double count_ = 0.0;
  double largest_ = 0.0;
  std::map<int, double> counts_;  // of values up to the bin-th power of kRatio; without zeros
};

}  // namespace tumblesight::sim
