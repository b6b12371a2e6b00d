#include "fsw/c/parameters.hpp"

#include <array>

#include "fsw/c/arguments.hpp"

using namespace tumblesight;

namespace tumblesight::fsw::c {
namespace {

static_assert(TUMBLESIGHT_FAULTS == kFaults);
static_assert(TUMBLESIGHT_RESPONSE_SAFE == static_cast<int>(Response::kSafe));

// In the order of fsw/config/parameters.inc.
constexpr std::array<std::uint32_t tumblesight_parameters::*, kParameters> kFields{
    &tumblesight_parameters::predicted_error_urad,      &tumblesight_parameters::attitude_jump_urad,
    &tumblesight_parameters::cycle_budget_us,           &tumblesight_parameters::scrub_blocks,
    &tumblesight_parameters::future_tolerance_us,       &tumblesight_parameters::max_frame_age_ms,
    &tumblesight_parameters::longest_coast_ms,          &tumblesight_parameters::chaser_time_tolerance_us,
    &tumblesight_parameters::events_of_a_kind,          &tumblesight_parameters::event_window_cycles,
    &tumblesight_parameters::longest_without_chaser_ms,
};
static_assert(kFields.back() != nullptr, "a parameter is missing here");

constexpr std::array<const char*, kTableFields> kNames{
#define TUMBLESIGHT_PARAMETER(name, lowest, highest, initial) #name,
#include "fsw/config/parameters.inc"
#undef TUMBLESIGHT_PARAMETER
    "rule of fault 0", "rule of fault 1", "rule of fault 2", "rule of fault 3", "rule of fault 4",
    "rule of fault 5", "rule of fault 6", "rule of fault 7", "rule of fault 8", "rule of fault 9",
};
static_assert(kNames.back() != nullptr);

std::uint32_t field_of(const tumblesight_fault_rule& rule) {
  return std::uint32_t{rule.cycles} << 24 | std::uint32_t{rule.window_cycles} << 16 |
         std::uint32_t{rule.good_cycles} << 8 | rule.response;
}

tumblesight_fault_rule rule_of(std::uint32_t field) {
  return {static_cast<std::uint8_t>(field >> 24), static_cast<std::uint8_t>(field >> 16 & 0xFF),
          static_cast<std::uint8_t>(field >> 8 & 0xFF), static_cast<std::uint8_t>(field & 0xFF)};
}

}  // namespace

ParameterTable table_of(const tumblesight_parameters& parameters) {
  ParameterTable table;
  for (std::size_t i = 0; i < kParameters; ++i) table.fields[i] = parameters.*kFields[i];
  for (std::size_t i = 0; i < TUMBLESIGHT_FAULTS; ++i)
    table.fields[kParameters + i] = field_of(parameters.fault_rules[i]);
  return table;
}

}  // namespace tumblesight::fsw::c

void tumblesight_initial_parameters(tumblesight_parameters* parameters) {
  if (fsw::c::status_of(parameters) != TUMBLESIGHT_OK) return;
  for (std::size_t i = 0; i < fsw::kParameters; ++i)
    parameters->*fsw::c::kFields[i] = fsw::kInitialTable.fields[i];
  for (std::size_t i = 0; i < TUMBLESIGHT_FAULTS; ++i)
    parameters->fault_rules[i] = fsw::c::rule_of(fsw::kInitialTable.fields[fsw::kParameters + i]);
}

tumblesight_status tumblesight_check_parameters(const tumblesight_parameters* parameters,
                                                tumblesight_wrong_parameter* wrong) {
  const tumblesight_status status =
      fsw::c::first_wrong({fsw::c::status_of(parameters), fsw::c::status_of_optional(wrong)});
  if (status != TUMBLESIGHT_OK) return status;
  const fsw::ParameterTable table = fsw::c::table_of(*parameters);
  const std::size_t field = fsw::first_wrong_field(table);
  if (field >= fsw::kTableFields) return TUMBLESIGHT_OK;
  if (wrong != nullptr) {
    *wrong = {fsw::c::kNames[field], table.fields[field], 0, 0};
    if (field < fsw::kParameters) {
      wrong->lowest = fsw::config::kParameterRules[field].lowest;
      wrong->highest = fsw::config::kParameterRules[field].highest;
    }
  }
  return TUMBLESIGHT_BAD_PARAMETER;
}
