// Condition: what makes a test harder than the nominal one. The table below is the only place that lists the
// conditions: command line, training, calibration, evaluation, reports and colours all follow it.
//
// To add a condition: an enumerator and its row here, and its test in tests/unit/sim/world/scenario. If it
// needs a sensor effect that does not exist yet, see sim/world/sensor/effects.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "sim/world/sensor/sensor_settings.hpp"

namespace tumblesight::sim {

// Append new ones at the end: the values are part of the fingerprints of training checkpoints.
enum class Condition { kNominal, kDegraded, kOccluded, kTumbling, kStress, kOffset, kOutliers, kApproach };

enum class RotationModel {
  kConstantRate,  // rate constant in the LiDAR frame (spin())
  kTorqueFree,    // rigid body with the target's inertia (Tumble)
};

// The rounds of training in which a condition takes its turn, see all_training_conditions().
using TrainingRounds = std::array<bool, 2>;
inline constexpr TrainingRounds kBothRounds{true, true};
inline constexpr TrainingRounds kFirstRound{true, false};
inline constexpr TrainingRounds kSecondRound{false, true};
inline constexpr TrainingRounds kNotTrained{false, false};  // for tests only

inline constexpr const char* kEveryTarget = nullptr;
inline constexpr const char* kNoTarget = "";

struct ConditionRow {
  Condition condition;
  const char* name;         // on the command line, in files and tables
  const char* explanation;  // one line, for help texts
  SensorSettings sensor;    // the paper's under it
  RotationModel rotation;
  double inertia_zz_factor;  // kTorqueFree: applied to the target's inertia about z
  bool occluded;             // a part of the chaser moves through the view
  double max_offset_swaths;  // the target lies off the boresight by up to this; 0: on it
  bool approaches;           // the chaser closes in, see approach.hpp
  TrainingRounds training;
  bool trained_in_paper;  // one of the paper's training conditions
  bool calibrates;        // its frames determine the scales of quantization
  // Key of the only target that `evaluate --paper` tests under it, or kEveryTarget, or kNoTarget.
  const char* evaluated_for;
};

inline constexpr double kMaxOffset_swaths = 0.2;

inline constexpr SensorSettings kPaperSensor{};
inline constexpr SensorSettings kDegradedSensor{100, 0.1, 0.0};
inline constexpr SensorSettings kOutlierSensor{128, 0.0, 0.01};

// In the order of Condition. Results and help texts list the conditions in this order.
// clang-format off
inline constexpr ConditionRow kConditions[] = {
    {Condition::kNominal, "nominal", "resolution FOV/128, range noise 0.1 m + 1 %",
     kPaperSensor, RotationModel::kConstantRate, 1.0, false, 0.0, false, kBothRounds, true, true, kEveryTarget},
    {Condition::kDegraded, "degraded", "resolution FOV/100, 10 % of the returns removed",
     kDegradedSensor, RotationModel::kConstantRate, 1.0, false, 0.0, false, kBothRounds, true, true, kEveryTarget},
    {Condition::kOccluded, "occluded", "a part of the chaser hides 5 to 30 % of the target's returns",
     kPaperSensor, RotationModel::kConstantRate, 1.0, true, 0.0, false, kBothRounds, false, true, kEveryTarget},
    {Condition::kTumbling, "tumbling", "torque-free rotation with the target's inertia",
     kPaperSensor, RotationModel::kTorqueFree, 1.0, false, 0.0, false, kBothRounds, false, false, kEveryTarget},
    {Condition::kStress, "stress", "tumbling with the inertia about z halved",
     kPaperSensor, RotationModel::kTorqueFree, 0.5, false, 0.0, false, kNotTrained, false, false, "near_shoemaker"},
    {Condition::kOffset, "offset", "target off the boresight by up to 20 % of the swath", kPaperSensor,
     RotationModel::kConstantRate, 1.0, false, kMaxOffset_swaths, false, kFirstRound, false, false, kEveryTarget},
    {Condition::kOutliers, "outliers", "1 % of the returns wrong by 5 sigma to 20 m",
     kOutlierSensor, RotationModel::kConstantRate, 1.0, false, 0.0, false, kSecondRound, false, true, kEveryTarget},
    {Condition::kApproach, "approach", "the chaser closes in to 12 m at up to 0.5 m/s, drifts and turns",
     kPaperSensor, RotationModel::kConstantRate, 1.0, false, 0.0, true, kNotTrained, false, false, kNoTarget},
};
// clang-format on

const ConditionRow& row_of(Condition condition);

std::string to_string(Condition condition);
std::vector<std::string> condition_names();
// One line per condition, "  name  explanation", for help texts.
std::string condition_explanations();
// Throws std::invalid_argument that lists the known conditions if `name` is not one of them.
Condition condition_from(const std::string& name);

// The sensor under a condition, with effects. `base`: a sensor in place of the paper's; rays that a condition
// takes away are a share of its rays.
SensorSettings sensor_settings(Condition condition, const Effects& effects = {},
                               const SensorSettings& base = {});
// Whether the target's inertia must be known.
bool needs_inertia(Condition condition);

// The conditions for training on everything that a network must handle: two rounds one after the other.
// Training draws the conditions in turn, so that a condition in only one of the rounds is drawn half as often
// as a condition in both.
std::vector<Condition> all_training_conditions();
// The paper's training conditions: nominal and degraded.
std::vector<Condition> paper_training_conditions();
std::vector<Condition> calibration_conditions();
// The tests of `target` for the results of `evaluate --paper`: the paper's own conditions and those beyond
// it.
std::vector<Condition> evaluated_conditions(const std::string& target);

}  // namespace tumblesight::sim
