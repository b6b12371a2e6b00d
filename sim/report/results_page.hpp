// Results as an HTML page: one self-contained file, figures as inline SVG, no scripts, nothing loaded.
#pragma once

#include <string>

#include "sim/evaluation/results.hpp"

namespace tumblesight::sim {

std::string results_page(const Results& results);

}  // namespace tumblesight::sim
