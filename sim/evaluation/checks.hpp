// Checks: requirements on a network beyond its errors in the tables.
#pragma once

#include <string>
#include <vector>

#include "sim/evaluation/results.hpp"

namespace tumblesight::sim {

struct Check {
  std::string what;
  double value = 0.0;
  double limit = 0.0;  // inclusive
  std::string unit;    // of both, as appended to the number
  bool holds() const { return value <= limit; }
};

// The checks that the runs of this subject allow: flatness over range and rate (largest over smallest bin),
// increase of the error off the boresight, drift in a long run (mean of its second half over the mean of the
// tenth frame).
std::vector<Check> checks_of(const SubjectResult& subject);

// "1.32×, at most 1.5×"
std::string text_of(const Check& check);

}  // namespace tumblesight::sim
