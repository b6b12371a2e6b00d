// What the application knows from one cycle to the next, but for the estimator's state and the events on
// their way. Kept three times (voted.hpp).
#pragma once

#include <array>
#include <cstdint>

#include "fsw/app/assertion.hpp"
#include "fsw/app/attitude_check.hpp"
#include "fsw/app/event_log.hpp"
#include "fsw/app/fault_monitor.hpp"
#include "fsw/app/frame_gate.hpp"
#include "fsw/app/model_banks.hpp"
#include "fsw/app/modes.hpp"
#include "hal/link.hpp"
#include "hal/platform.hpp"

namespace tumblesight::fsw {

// What protects the application from bit flips; all of it, but to measure what it buys
// (tests/campaigns/fault).
struct Protections {
  bool memory = true;    // vote, guards and scrubbing
  bool attitude = true;  // checks of the attitude
};

struct alignas(8) AppState {
  std::int64_t now_ns = 0;
  hal::Platform platform;
  const char* expected_target = nullptr;
  hal::Housekeeping counters;
  FrameGate gate;
  FaultMonitor faults;
  AttitudeCheck attitude_check;
  ModelBanksState banks;
  AssertionLog assertions;
  std::array<std::uint32_t, kLimits> limits{};
  std::uint32_t faults_seen = 0;      // in this cycle, bits
  std::uint32_t estimator_crc32 = 0;  // of its state as the last cycle left it
  std::uint32_t constants_crc32 = 0;  // of what it keeps of the model
  std::array<gnc::ModelStatus, hal::kModelBanks> boot_status{};
  Protections protections;
  Mode mode = Mode::kBoot;
  bool boot_to_report = false;
  bool has_cycle = false;
  bool outage = false;  // the previous cycle had no frame

  std::uint32_t limit(Limit which) const { return limits[static_cast<std::size_t>(which)]; }
  bool has_model() const { return banks.status(banks.in_use) == BankStatus::kGood; }
};

// Raises events of the cycle that runs.
class Reporter {
 public:
  Reporter(AppState& state, EventLog& log) : state_(state), log_(log) {}
  void operator()(EventId id, std::int32_t a = 0, std::int32_t b = 0, std::int32_t c = 0) const {
    log_.raise(state_.now_ns, id, a, b, c, state_.counters);
  }

 private:
  AppState& state_;
  EventLog& log_;
};

}  // namespace tumblesight::fsw
