// RunConditions: under what the frames of a run or of a cell of results are made, beside the condition by
// name.
#pragma once

#include "sim/evaluation/target_symmetry.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/sensor/sensor_description.hpp"

namespace tumblesight::sim {

struct RunConditions {
  Disturbances disturbances;
  Effects effects;
  SensorDescription sensor;
  RangeLimits ranges;
  TargetSymmetry symmetry;  // all errors are modulo it
};

}  // namespace tumblesight::sim
