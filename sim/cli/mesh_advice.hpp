// What wrong attitudes can mean: where a mesh of the user's own was shown to a network, another spacecraft,
// other axes, another unit; otherwise a network that knows too little.
#pragma once

#include <string>

#include "sim/cli/arguments.hpp"
#include "sim/evaluation/metrics.hpp"

namespace tumblesight::sim {

struct Swaths {
  double mesh_m = 0.0;     // that the mesh needs
  double network_m = 0.0;  // that the network was trained for
};

// Text as a paragraph for the terminal. `further`: before the second and later lines.
std::string paragraph(const std::string& text, const std::string& further = "  ");

// Lines for the terminal. Empty if most of the last frames are within 20 degrees.
std::string mesh_advice(const ScenarioArguments& arguments, const Swaths& swaths, const ErrorSummary& last,
                        const CommonTurn& common);

}  // namespace tumblesight::sim
