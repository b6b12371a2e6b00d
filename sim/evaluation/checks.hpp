// Checks: what is required of a network beyond its errors in the tables, and whether it holds.
#pragma once

#include <string>
#include <vector>

#include "sim/evaluation/results.hpp"

namespace tumblesight::sim {

// Mean at most the goal's and share at least the goal's.
bool meets(const ErrorSummary& summary, const PaperFigure& goal);

struct Check {
  std::string what;
  double value = 0.0;
  double limit = 0.0;  // holds up to here
  std::string unit;    // behind both
  bool holds() const { return value <= limit; }
};

// Of what was run only: flat over range and rate (largest over smallest bin), cost of a target off the
// boresight, drift in a long run (mean of its second half over the tenth frame's).
std::vector<Check> checks_of(const SubjectResult& subject);

// "1.32×, at most 1.5×"
std::string text_of(const Check& check);

}  // namespace tumblesight::sim
