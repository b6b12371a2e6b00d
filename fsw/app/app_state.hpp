// The state that the application keeps between cycles, except the estimator's state and the waiting events.
// Three copies are kept (voted.hpp).
#pragma once

#include <array>
#include <cstdint>

#include "fsw/app/assertion.hpp"
#include "fsw/app/event_log.hpp"
#include "fsw/app/fault_monitor.hpp"
#include "fsw/app/model_banks.hpp"
#include "fsw/app/modes.hpp"
#include "fsw/config/numerics.hpp"
#include "gnc/rcnn/attitude_estimator.hpp"
#include "gnc/tracking/frame_tracker.hpp"
#include "hal/messages/telemetry.hpp"
#include "hal/platform.hpp"

namespace tumblesight::fsw {

using Estimator = gnc::AttitudeEstimator<Numerics>;

// The protections against bit flips. tests/campaigns/fault switches them off to measure their effect.
struct Protections {
  bool memory = true;    // vote, guards and scrubbing
  bool attitude = true;  // checks of the attitude
};

struct alignas(8) AppState {
  std::int64_t now_ns = 0;  // time of the cycle
  hal::Platform platform;
  const char* expected_target = nullptr;
  hal::Telemetry counters;
  gnc::FrameTrackerState tracking;
  FaultMonitor faults;
  ModelBanksState banks;
  AssertionLog assertions;
  std::array<std::uint32_t, kLimits> limits{};
  std::uint32_t faults_seen = 0;      // in this cycle; bit n: Fault n
  std::uint32_t estimator_crc32 = 0;  // of the estimator's state at the end of the last cycle
  std::uint32_t constants_crc32 = 0;  // of the estimator's copy of model data
  std::array<gnc::ModelStatus, hal::kModelBanks> boot_status{};
  Protections protections;
  Mode mode = Mode::kBoot;
  bool boot_to_report = false;  // the next step reports what init() found
  bool has_cycle = false;       // now_ns is the time of a cycle
  bool outage = false;          // the previous cycle had no frame

  gnc::FrameTrackerLimits tracker_limits() const {
    return {config::kFrameTimeLimits,         config::kLongestCoast_ns,
            config::kChaserTimeTolerance_ns,  limit(Limit::kPredictedError_urad),
            limit(Limit::kAttitudeJump_urad), protections.attitude};
  }
  std::uint32_t limit(Limit which) const { return limits[static_cast<std::size_t>(which)]; }
  bool has_model() const { return banks.status(banks.in_use) == BankStatus::kGood; }
};

// Raises events with the time of the current cycle.
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
