// The faults that a user can inject into a running simulation. A fault is given by its name, a strength in
// the unit of the table, and a number of steps. docs/console.md explains them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tumblesight::sim {

struct FaultRow {
  std::string name;
  std::string explanation;  // one line
  std::string unit;         // of the strength
  // Limits of the strength. Both 0: the fault has none, has_strength().
  double lowest = 0.0, highest = 0.0;
  bool must_be_whole = false;  // the strength
  // True: it changes what the sensor sees, and frames are rendered with it (SceneFaults). False: it changes
  // the frames that the sensor delivers (FrameFaults).
  bool is_of_scene = false;
};

// A fault for the next steps.
struct InjectedFault {
  std::string name;
  double strength = 0.0;
  std::uint32_t steps = 1;
};
inline constexpr std::uint32_t kMostFaultSteps = 1000;

bool has_strength(const FaultRow& row);
// "a number from 0.1 to 10 m"
std::string strength_limits(const FaultRow& row);

// The faults of frames, an occluder, a chaser that turns, and the effects of sim/world/sensor/effects.hpp
// except those that change the target's body.
const std::vector<FaultRow>& fault_table();
// Throws std::invalid_argument, with all names, if no fault has this name.
const FaultRow& fault_named(const std::string& name);
// Throws std::invalid_argument that names fault, value and limits.
void require_possible(const InjectedFault& fault);
// "debris 1.5 m for 5 steps"
std::string to_string(const InjectedFault& fault);

}  // namespace tumblesight::sim
