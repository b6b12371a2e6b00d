// The state that the application keeps between cycles, except the estimator and the tables and copies of
// MemoryScrubber. Three copies are kept (triple_redundant.hpp). Data that the platform passes by pointer is
// copied into this state.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>

#include "fsw/app/assertion.hpp"
#include "fsw/app/command_authority.hpp"
#include "fsw/app/event_log.hpp"
#include "fsw/app/fault_monitor.hpp"
#include "fsw/app/model_banks.hpp"
#include "fsw/app/modes.hpp"
#include "fsw/app/parameter_table.hpp"
#include "fsw/app/stored_state.hpp"
#include "fsw/config/numerics.hpp"
#include "gnc/estimation/attitude_estimator.hpp"
#include "gnc/estimation/frame_tracker.hpp"
#include "hal/messages/telemetry.hpp"
#include "hal/platform.hpp"

namespace tumblesight::fsw {

using Estimator = gnc::AttitudeEstimator<Numerics>;

// The target whose models are accepted. A longer name than an image can hold matches none.
class ExpectedTarget {
 public:
  void set(const char* name) {
    has_name_ = name != nullptr;
    name_ = {};
    if (!has_name_) return;
    for (std::size_t i = 0; i + 1 < name_.size() && name[i] != 0; ++i) name_[i] = name[i];
  }
  const char* name() const { return has_name_ ? name_.data() : nullptr; }  // nullptr: any

 private:
  std::array<char, std::tuple_size_v<decltype(gnc::ModelHeader::target)> + 1> name_{};
  bool has_name_ = false;
};

// The copies that hold the newest record.
class StoredCopies {
 public:
  static constexpr StoredCopies all() {
    StoredCopies copies;
    for (int copy = 0; copy < hal::kStoredCopies; ++copy) copies.set(copy, true);
    return copies;
  }
  constexpr void set(int copy, bool good) { bits_ = (bits_ & ~(1U << copy)) | (good ? 1U : 0U) << copy; }
  bool has(int copy) const { return (bits_ >> copy & 1U) != 0; }
  std::uint32_t number() const { return (bits_ & 1U) + (bits_ >> 1 & 1U); }

 private:
  std::uint32_t bits_ = 0;
};
static_assert(hal::kStoredCopies == 2);

// What the persistent store holds (state_keeper.hpp).
struct StoredRecord {
  StoredState last;  // the newest record, whether it could be written or not
  std::uint32_t generation = 0;
  StoredCopies good = StoredCopies::all();
  std::uint32_t failing_cycles = 0;  // consecutive ones that ended with less than all copies
  std::uint32_t cycles_since_check = 0;
  bool given_up = false;
  bool has_unstored_change = false;  // since the last cycle with a good copy, and not reported
};

// What init() found in the persistent store.
struct Resumption {
  StoredState stored;  // initial values where nothing is found
  std::array<StoreStatus, hal::kStoredCopies> copies{};
  std::uint32_t lost = 0;       // sum of hal::StateLoss
  bool found = false;           // mode and bank, too
  bool to_report = false;       // by the next step
  std::uint8_t first_copy = 0;  // to be written first, since the other one holds the newest record
};

struct alignas(8) AppState {
  std::int64_t now_ns = 0;  // time of the cycle
  hal::Platform platform;   // without the keys, which are in the authority
  CommandAuthority authority;
  ExpectedTarget expected_target;
  EventLog events;
  StoredRecord stored;
  Resumption resumption;
  hal::Telemetry counters;
  gnc::FrameTrackerState tracking;
  FaultMonitor faults;
  ModelBanksState banks;
  AssertionLog assertions;
  ParameterTable table = kInitialTable;  // the active one
  LoadedTable loaded_table;
  std::uint32_t faults_seen = 0;      // in this cycle; bit n: Fault n
  std::uint32_t estimator_crc32 = 0;  // of the estimator's state at the end of the last cycle
  std::uint32_t constants_crc32 = 0;  // of the estimator's copy of model data
  std::uint32_t words_corrected = 0;  // by the vote of AttitudeInitApp::use(), and not yet reported
  std::uint32_t frames_unused = 0;    // superseded, passed over or overflowed since the last used one
  std::array<gnc::ModelStatus, hal::kModelBanks> boot_status{};
  Mode mode = Mode::kBoot;
  bool boot_to_report = false;    // the next step reports what init() found
  bool has_cycle = false;         // now_ns is the time of a cycle
  bool outage = false;            // the previous cycle had no frame
  bool long_task = false;         // this cycle has one: begin_long_task()
  bool pose_is_verified = false;  // the last one that was reported
  bool table_is_given = false;    // by AttitudeInitApp::use(), so that a stored one is older

  gnc::FrameTimeLimits time_limits() const;
  gnc::FrameTrackerLimits tracker_limits() const;
  EventLimits event_limits() const {
    return {table[Parameter::kEventsOfAKind], table[Parameter::kEventWindow_cycles]};
  }
  // A cycle has at most one long task: the repair of a table or of the constants, or the check of an image
  // for a command or a switch of banks. Such a cycle estimates no frame, so every step stays within the time
  // in docs/audit.md. False: the cycle has had one; a repair waits for the next cycle, a command is refused.
  [[nodiscard]] bool begin_long_task() {
    const bool begins = !long_task;
    long_task = true;
    return begins;
  }
  bool has_model() const { return banks.status(banks.in_use) == BankStatus::kGood; }
};

// Raises events with the time of the current cycle.
class Reporter {
 public:
  Reporter(AppState& state, EventLog& log) : state_(state), log_(log) {}
  void operator()(EventId id, std::int32_t a = 0, std::int32_t b = 0, std::int32_t c = 0) const;

 private:
  AppState& state_;
  EventLog& log_;
};

}  // namespace tumblesight::fsw
