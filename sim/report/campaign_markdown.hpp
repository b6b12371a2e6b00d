// The report of a campaign as text: every run with bounds of its rates, and its worst sequences.
#pragma once

#include <string>

#include "sim/evaluation/results.hpp"

namespace tumblesight::sim {

std::string campaign_markdown(const Results& results);

}  // namespace tumblesight::sim
