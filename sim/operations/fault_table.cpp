#include "sim/operations/fault_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <variant>

#include "sim/host/text.hpp"
#include "sim/world/sensor/effects.hpp"

namespace tumblesight::sim {
namespace {

std::vector<FaultRow> make_fault_table() {
  std::vector<FaultRow> table{
      {"drop", "no frame is delivered", ""},
      {"freeze", "the last image is repeated under new numbers and times", ""},
      {"delay", "each frame is delivered a step late", ""},
      {"occlude", "a part of the chaser hides this share of the target's returns", "of the returns", 0.01,
       1.0, false, true},
      {"turn",
       "the chaser turns about a fixed axis and keeps the target on the boresight; it stays turned until the "
       "sequence ends",
       "deg/s", 0.01, 20.0, false, true}};
  for (const EffectRow& row : effect_table()) {
    if (std::holds_alternative<BodyEffect>(row.apply)) continue;
    table.push_back({row.name, row.explanation, row.unit, row.lowest, row.highest, must_be_whole(row), true});
  }
  return table;
}

}  // namespace

const std::vector<FaultRow>& fault_table() {
  static const std::vector<FaultRow> kTable = make_fault_table();
  return kTable;
}

bool has_strength(const FaultRow& row) {
  return row.lowest != 0.0 || row.highest != 0.0;
}

std::string strength_limits(const FaultRow& row) {
  return fmt::format("a {} from {:g} to {:g}{}{}{}", row.must_be_whole ? "whole number" : "number",
                     row.lowest, row.highest, row.unit.empty() ? "" : " ", row.unit,
                     row.lowest < 0.0 ? ", and not 0" : "");
}

const FaultRow& fault_named(const std::string& name) {
  std::string known;
  for (const FaultRow& row : fault_table()) {
    if (name == row.name) return row;
    known += (known.empty() ? "" : ", ") + row.name;
  }
  for (const EffectRow& row : effect_table()) {
    if (name != row.name) continue;
    throw std::invalid_argument(fmt::format(
        "{} changes the target's body, which a run keeps: start one with simulate --effect {}", name, name));
  }
  throw std::invalid_argument(
      fmt::format("there is no fault '{}'; the faults are: {}", shortened(name), known));
}

namespace {

bool takes(const FaultRow& row, double strength) {
  if (!has_strength(row)) return strength == 0.0;
  const bool is_within = strength >= row.lowest && strength <= row.highest && strength != 0.0;
  return is_within && (!row.must_be_whole || strength == std::floor(strength));
}

}  // namespace

void require_possible(const InjectedFault& fault) {
  const FaultRow& row = fault_named(fault.name);
  if (fault.steps < 1 || fault.steps > kMostFaultSteps)
    throw std::invalid_argument(
        fmt::format("fault {}: steps must be 1 to {}, not {}", fault.name, kMostFaultSteps, fault.steps));
  if (takes(row, fault.strength)) return;
  if (!has_strength(row))
    throw std::invalid_argument(
        fmt::format("fault {} has no strength: leave out {:g}", fault.name, fault.strength));
  throw std::invalid_argument(fmt::format("fault {}: the strength must be {}, not {:g}", fault.name,
                                          strength_limits(row), fault.strength));
}

std::string to_string(const InjectedFault& fault) {
  const FaultRow& row = fault_named(fault.name);
  std::string text = fault.name;
  if (has_strength(row))
    text += fmt::format(" {:g}{}{}", fault.strength, row.unit.empty() ? "" : " ", row.unit);
  return text + fmt::format(" for {} step{}", fault.steps, fault.steps == 1 ? "" : "s");
}

}  // namespace tumblesight::sim
