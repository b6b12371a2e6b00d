// The conditions that a network is trained on, as words of the command line and as part of a checkpoint's
// fingerprint.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/world/scenario/condition.hpp"

namespace tumblesight::sim {

// The words of the command line: "all", "paper", and the name of every condition that may be trained on.
std::vector<std::string> training_condition_words();
// The conditions of the words, one after the other: "all" is all_training_conditions(), "paper" is
// paper_training_conditions(). Throws std::invalid_argument for an unknown word.
std::vector<Condition> training_conditions(const std::vector<std::string>& words);
// Hash of the conditions and of the sets of effects, each in its order, for a checkpoint's fingerprint.
std::uint64_t conditions_hash(const std::vector<Condition>& conditions,
                              const std::vector<EffectRanges>& effect_sets = {});

}  // namespace tumblesight::sim
