// What a mission asks of the training: its conditions and the effects of its moving parts.
#pragma once

#include <vector>

#include "sim/mission/mission.hpp"
#include "sim/world/scenario/condition.hpp"
#include "sim/world/sensor/effects.hpp"

namespace tumblesight::sim {

// The conditions of the mission by their weights, mixed as evenly as possible, since they take turns; without
// any, those of all_training_conditions(). Throws std::invalid_argument that names a condition that is for
// tests only.
std::vector<Condition> training_conditions(const Mission& mission);

// Whether the panels of the mission turn.
bool panels_turn(const Mission& mission);

// No effects; for a mission whose panels turn also a set with the panels at any angle within their limits.
std::vector<EffectRanges> training_effect_sets(const Mission& mission);

}  // namespace tumblesight::sim
