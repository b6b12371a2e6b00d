// The fields of the housekeeping, by their names, which hal::Housekeeping and the topic sil/telemetry share.
#pragma once

#include <algorithm>
#include <iterator>

namespace tumblesight::hal::dds {

template <class From, class To>
void copy_telemetry(const From& from, To& to) {
  to.time_ns = from.time_ns;
  to.mode = from.mode;
  to.safe_cause = from.safe_cause;
  to.safe_fault = from.safe_fault;
  to.faults_persisting = from.faults_persisting;
  to.responses_disabled = from.responses_disabled;
  to.cycles = from.cycles;
  to.commands_accepted = from.commands_accepted;
  to.commands_refused = from.commands_refused;
  std::copy(std::begin(from.commands_refused_by), std::end(from.commands_refused_by),
            std::begin(to.commands_refused_by));
  to.command_counter = from.command_counter;
  to.frames_used = from.frames_used;
  to.frames_missing = from.frames_missing;
  to.frames_refused = from.frames_refused;
  to.frames_duplicate = from.frames_duplicate;
  to.frames_stale = from.frames_stale;
  to.frames_bad = from.frames_bad;
  to.sequence_gaps = from.sequence_gaps;
  to.estimator_resets = from.estimator_resets;
  to.attitudes_doubtful = from.attitudes_doubtful;
  to.events = from.events;
  to.events_suppressed = from.events_suppressed;
  to.events_lost = from.events_lost;
  to.events_waiting = from.events_waiting;
  to.events_waiting_max = from.events_waiting_max;
  to.memory_corrections = from.memory_corrections;
  to.states_restored = from.states_restored;
  to.states_lost = from.states_lost;
  to.constants_reloaded = from.constants_reloaded;
  to.model_blocks_repaired = from.model_blocks_repaired;
  to.model_blocks_lost = from.model_blocks_lost;
  to.model_tables_rebuilt = from.model_tables_rebuilt;
  to.model_passes = from.model_passes;
  to.bank_switches = from.bank_switches;
  to.bank_in_use = from.bank_in_use;
  to.second_copy = from.second_copy;
  std::copy(std::begin(from.bank_status), std::end(from.bank_status), std::begin(to.bank_status));
  std::copy(std::begin(from.bank_crc32), std::end(from.bank_crc32), std::begin(to.bank_crc32));
  to.model_bytes_loaded = from.model_bytes_loaded;
  to.inference_us = from.inference_us;
  to.inference_max_us = from.inference_max_us;
  to.step_us = from.step_us;
  to.step_max_us = from.step_max_us;
  std::copy(std::begin(from.steps_by_time), std::end(from.steps_by_time), std::begin(to.steps_by_time));
  to.deadline_overruns = from.deadline_overruns;
  to.cycle_slips = from.cycle_slips;
  to.heap_allocations = from.heap_allocations;
  to.stack_left_min_bytes = from.stack_left_min_bytes;
}

}  // namespace tumblesight::hal::dds
