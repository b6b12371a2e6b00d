#include "fsw/app/fault_monitor.hpp"

namespace tumblesight::fsw {
namespace {

constexpr bool is_in_order() {
  for (int i = 0; i < kFaults; ++i) {
    if (config::kFaultRules[static_cast<std::size_t>(i)].fault != static_cast<Fault>(i)) return false;
  }
  return true;
}
static_assert(is_in_order(), "the table is indexed by the fault's number");

static_assert(kFaults <= 32, "the telemetry has one bit per fault");

// The bits of the history that a rule looks at.
constexpr std::uint32_t window_of(const config::FaultRule& rule) {
  return UINT32_MAX >> (config::kMaxFaultWindow_cycles - rule.window_cycles);
}

constexpr std::uint32_t count_of_bits(std::uint32_t word) {
  std::uint32_t count = 0;
  for (int bit = 0; bit < 32; ++bit) count += word >> bit & 1U;
  return count;
}

}  // namespace

FaultMonitor::Change FaultMonitor::observe(const config::FaultRule& rule, bool present) {
  const Fault fault = rule.fault;
  std::uint32_t& history = history_[static_cast<std::size_t>(fault)];
  std::uint8_t& good_cycles = good_cycles_[static_cast<std::size_t>(fault)];
  history = (history << 1 | (present ? 1U : 0U)) & window_of(rule);
  if (present) {
    good_cycles = 0;
    if (count_of_bits(history) < rule.cycles) return Change::kNone;
    history = 0;
    persisting_ |= bit_of(fault);
    return Change::kPersists;
  }
  if (good_cycles < UINT8_MAX) ++good_cycles;
  if ((persisting_ & bit_of(fault)) == 0 || good_cycles < rule.good_cycles) return Change::kNone;
  history = 0;
  persisting_ &= ~bit_of(fault);
  return Change::kOver;
}

void FaultMonitor::hold(Fault fault) {
  good_cycles_[static_cast<std::size_t>(fault)] = 0;
}

Response FaultMonitor::response_to(const config::FaultRule& rule) const {
  return (disabled_ & bit_of(rule.fault)) != 0 ? Response::kFlag : rule.response;
}

bool FaultMonitor::enable(std::uint8_t fault, bool enabled) {
  if (fault >= kFaults) return false;
  const auto known = static_cast<Fault>(fault);
  if (enabled) {
    disabled_ &= ~bit_of(known);
    return true;
  }
  if (!config::kFaultRules[fault].can_be_disabled) return false;
  disabled_ |= bit_of(known);
  return true;
}

}  // namespace tumblesight::fsw
