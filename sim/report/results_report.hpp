// Results as one self-contained HTML page with figures as inline SVG.
#pragma once

#include <string>

#include "sim/evaluation/results.hpp"

namespace tumblesight::sim {

std::string results_report(const Results& results);

}  // namespace tumblesight::sim
