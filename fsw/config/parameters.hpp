// The parameters of the application, out of the rows of parameters.inc.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tumblesight::fsw {

enum class Parameter : std::uint8_t {
#define TUMBLESIGHT_PARAMETER(name, lowest, highest, initial) k##name,
#include "fsw/config/parameters.inc"
#undef TUMBLESIGHT_PARAMETER
};

namespace config {

struct ParameterRule {
  std::uint32_t lowest;
  std::uint32_t highest;
  std::uint32_t initial;  // after init()
};

inline constexpr std::array kParameterRules{
#define TUMBLESIGHT_PARAMETER(name, lowest, highest, initial) ParameterRule{lowest, highest, initial},
#include "fsw/config/parameters.inc"
#undef TUMBLESIGHT_PARAMETER
};

constexpr const ParameterRule& rule_of(Parameter parameter) {
  return kParameterRules[static_cast<std::size_t>(parameter)];
}

}  // namespace config

inline constexpr std::size_t kParameters = config::kParameterRules.size();

}  // namespace tumblesight::fsw
