#include "sim/training/training_conditions.hpp"

#include "sim/world/math/random.hpp"

namespace tumblesight::sim {
namespace {

std::vector<Condition> conditions_of(const std::string& word) {
  if (word == "all") return all_training_conditions();
  if (word == "paper") return paper_training_conditions();
  return {condition_from(word)};
}

}  // namespace

std::vector<std::string> training_condition_words() {
  std::vector<std::string> words{"all", "paper"};
  for (const ConditionRow& row : kConditions) {
    if (row.training != kNotTrained) words.emplace_back(row.name);
  }
  return words;
}

std::vector<Condition> training_conditions(const std::vector<std::string>& words) {
  std::vector<Condition> conditions;
  for (const std::string& word : words) {
    const std::vector<Condition> more = conditions_of(word);
    conditions.insert(conditions.end(), more.begin(), more.end());
  }
  return conditions;
}

// The first set adds only its effects, so that checkpoints from before there were more of them stay valid.
std::uint64_t conditions_hash(const std::vector<Condition>& conditions,
                              const std::vector<EffectRanges>& effect_sets) {
  std::uint64_t hash = 0;
  for (const Condition condition : conditions) hash = mix(hash, static_cast<std::uint64_t>(condition));
  std::string sets;
  for (const EffectRanges& effects : effect_sets) {
    if (&effects != &effect_sets.front()) sets += '/';
    sets += to_string(effects);
  }
  for (const char c : sets) hash = mix(hash, static_cast<std::uint64_t>(c));
  return hash;
}

}  // namespace tumblesight::sim
