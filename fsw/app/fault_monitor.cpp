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

const config::FaultRule& rule_of(Fault fault) {
  return config::kFaultRules[static_cast<std::size_t>(fault)];
}

}  // namespace

FaultMonitor::Change FaultMonitor::observe(Fault fault, bool present) {
  std::uint16_t& cycles = cycles_[static_cast<std::size_t>(fault)];
  if (!present) {
    const bool persisted = (persisting_ & bit_of(fault)) != 0;
    persisting_ &= ~bit_of(fault);
    cycles = 0;
    return persisted ? Change::kOver : Change::kNone;
  }
  ++cycles;
  if (cycles < rule_of(fault).persistence_cycles) return Change::kNone;
  cycles = 0;
  persisting_ |= bit_of(fault);
  return Change::kPersists;
}

Response FaultMonitor::response_to(Fault fault) const {
  return (disabled_ & bit_of(fault)) != 0 ? Response::kFlag : rule_of(fault).response;
}

bool FaultMonitor::enable(std::uint8_t fault, bool enabled) {
  if (fault >= kFaults) return false;
  const auto known = static_cast<Fault>(fault);
  if (enabled) {
    disabled_ &= ~bit_of(known);
    return true;
  }
  if (!rule_of(known).can_be_disabled) return false;
  disabled_ |= bit_of(known);
  return true;
}

}  // namespace tumblesight::fsw
