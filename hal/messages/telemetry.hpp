// Telemetry: modes, counters, faults, banks and times of the application, once per cycle. All counters
// saturate.
#pragma once

#include <array>
#include <cstdint>

#include "hal/messages/bank_status.hpp"
#include "hal/messages/command_refusal.hpp"
#include "hal/messages/fault.hpp"
#include "hal/messages/mode.hpp"
#include "hal/messages/store_status.hpp"
#include "hal/messages/table_status.hpp"

namespace tumblesight::hal {

// The same fields in the same order as struct Telemetry of hal/dds/idl/tumblesight.idl, which has run_id and
// k before them; tests/documents/icd.py compares both.
struct Telemetry {
  static constexpr int kCycleTimeBins = 8;
  static constexpr int kBanks = 2;

  std::int64_t time_ns = 0;  // cycle time
  Mode mode = Mode::kBoot;
  Cause safe_cause = Cause::kNone;       // of the last change to SAFE; NONE: never since start
  Fault safe_fault = Fault::kStateLost;  // valid if safe_cause is FAULT
  std::uint32_t faults_persisting = 0;   // bit n: Fault n
  std::uint32_t responses_disabled = 0;  // bit n: Fault n
  std::uint32_t cycles = 0;

  std::uint32_t commands_accepted = 0;
  std::uint32_t commands_refused = 0;
  std::array<std::uint32_t, kCommandRefusals> commands_refused_by{};  // indexed by CommandRefusal
  std::uint32_t command_counter = 0;                                  // of the last authentic command
  std::uint8_t key_slot = 0;                                          // that signs commands
  StoreHealth store_health = StoreHealth::kNone;
  std::uint32_t state_writes_failed = 0;  // writes of the stored state that did not reach both copies, and
                                          // checks that found a copy changed
  std::uint32_t store_given_up = 0;       // times that no copy could be written in ten consecutive cycles

  std::uint32_t frames_used = 0;
  std::uint32_t frames_missing = 0;
  std::uint32_t frames_refused = 0;    // all kinds below
  std::uint32_t frames_duplicate = 0;  // sequence number repeated
  std::uint32_t frames_stale = 0;     // exposure too old, in the future, or not far enough after the last one
  std::uint32_t frames_bad = 0;       // empty, flat, or wrong ray count, field of view or size
  std::uint32_t frames_repeated = 0;  // like one of the last eight used frames: a frozen sensor
  std::uint32_t frames_without_chaser = 0;  // the chaser's attitude is missing at the exposure
  std::uint32_t frames_superseded = 0;      // not refused: a newer frame of the same cycle was taken
  std::uint32_t frames_overflowed = 0;      // not refused: the sensor interface dropped them for lack of room
  std::uint32_t frames_passed_over = 0;     // not refused: the cycle had a long task or no good model
  std::uint32_t sequence_gaps = 0;          // sequence numbers skipped
  std::uint32_t estimator_resets = 0;
  std::uint32_t attitudes_doubtful = 0;
  std::uint32_t poses_verified = 0;

  std::uint32_t events = 0;             // sum of sent, waiting, suppressed and lost events
  std::uint32_t events_suppressed = 0;  // too many of the same kind
  std::uint32_t events_lost = 0;        // no room in the ring
  std::uint32_t events_waiting = 0;
  std::uint32_t events_waiting_max = 0;

  std::uint32_t memory_corrections = 0;  // words of the triple-redundant state
  std::uint32_t states_restored = 0;     // estimator states restored from the copy
  std::uint32_t states_lost = 0;         // estimator states whose copy was corrupted too
  std::uint32_t constants_reloaded = 0;
  std::uint32_t model_blocks_repaired = 0;
  std::uint32_t model_blocks_lost = 0;
  std::uint32_t model_tables_rebuilt = 0;
  std::uint32_t model_passes = 0;  // complete checks of the model in use
  std::uint32_t bank_switches = 0;

  std::uint8_t bank_in_use = 0;
  std::uint8_t second_copy = 0;  // 1: the other bank holds the same image
  std::uint8_t long_task = 0;    // 1: this cycle repaired or lost the model, or checked an image
  std::array<BankStatus, kBanks> bank_status{};      // per bank
  std::array<BankActivity, kBanks> bank_activity{};  // per bank
  std::array<std::uint32_t, kBanks> bank_crc32{};    // CRC-32 in the header of the bank's image
  std::uint32_t model_segments_missing = 0;          // of the image that is being loaded
  TableStatus table_status = TableStatus::kEmpty;    // of the table that was uplinked
  std::uint32_t table_crc32 = 0;                     // CRC-32 of the active table

  std::uint32_t inference_us = 0;  // last step of the estimator, by the stopwatch; not in any digest
  std::uint32_t inference_max_us = 0;
  // the previous cycle, from before it received until all was published; 0: not measured
  std::uint32_t cycle_us = 0;
  std::uint32_t cycle_max_us = 0;
  std::uint32_t store_us = 0;  // checks and writes of the stored state at the end of this step
  std::uint32_t store_max_us = 0;
  // cycles shorter than 1, 3, 10, 30, 100, 300 and 1000 ms, and all longer ones
  std::array<std::uint32_t, kCycleTimeBins> cycles_by_time{};
  std::uint32_t deadline_overruns = 0;        // cycles longer than their budget
  std::uint32_t registrations_cut_short = 0;  // by the deadline, so that the report was on time
  std::uint32_t cycle_slips = 0;
  std::uint32_t heap_allocations = 0;  // of the flight task since init, where the platform counts them
  // of the flight task's stack, never used since start; 0: the platform does not measure it
  std::uint32_t stack_left_min_bytes = 0;
};

}  // namespace tumblesight::hal
