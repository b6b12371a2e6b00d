// Results as a Markdown document: docs/results.md is one.
#pragma once

#include <string>

#include "sim/evaluation/results.hpp"

namespace tumblesight::sim {

std::string results_markdown(const Results& results);

}  // namespace tumblesight::sim
