// Errors and what a run was made with, as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "sim/evaluation/metrics.hpp"
#include "sim/evaluation/pose_errors.hpp"
#include "sim/world/scenario/disturbance.hpp"
#include "sim/world/sensor/effects.hpp"
#include "sim/world/sensor/sensor_description.hpp"

namespace tumblesight::sim {

// The figures of summary_figures() by their keys, then the standard errors of those in degrees. All null
// without a sequence.
nlohmann::ordered_json summary_json(const ErrorSummary& summary);

// The same with error_below_3_expected and expected_over_real.
nlohmann::ordered_json estimator_json(const ErrorSummary& summary);

// The figures of pose_figures() by their keys; null where one does not exist, or altogether without a pose.
nlohmann::ordered_json pose_json(const PoseSummary& pose);

// What was given, by the names of the table; empty for an undisturbed run.
nlohmann::ordered_json disturbances_json(const Disturbances& disturbances);

// "noise=5", or null without an effect.
nlohmann::ordered_json effect_json(const Effects& effects);
// Its name and what identifies it.
nlohmann::ordered_json sensor_json(const SensorDescription& sensor);

}  // namespace tumblesight::sim
