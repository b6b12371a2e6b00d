#include "fsw/app/state_digest.hpp"

#include "gnc/numerics/crc.hpp"
#include "hal/messages/message_digest.hpp"

namespace tumblesight::fsw {
namespace {

using Numbers = hal::NumberDigest<gnc::Crc32>;

// Each function below takes a structure apart into all its members. A new member does not compile until it is
// added here, or left out with a reason.

void add(Numbers& numbers, const gnc::FrameTrackerState& tracking) {
  const auto& [gate, q_inertial_lrf, has_chaser_attitude, has_jumped, has_found_rate, history] = tracking;
  numbers(gate.has_last());
  numbers(gate.last_exposure_time_ns());
  numbers(gate.last_sequence_number());
  numbers(q_inertial_lrf);
  numbers(has_chaser_attitude);
  numbers(has_jumped);
  numbers(has_found_rate);
  for (const gnc::FrameSignature& signature : history.signatures()) numbers(signature);
  numbers(history.next());
}

void add(Numbers& numbers, const ModelBanksState& banks) {
  const auto& [descriptor, in_use, next_block, next_copied, segments_missing, missing, table_crc32] = banks;
  for (const auto& [size_bytes, crc32, status] : descriptor) {
    numbers(size_bytes);
    numbers(crc32);
    numbers(status);
  }
  numbers(in_use);
  numbers(next_block);
  numbers(next_copied);
  numbers(segments_missing);
  numbers(missing);
  numbers(table_crc32);
}

void add(Numbers& numbers, const ParameterTable& table) {
  numbers(table.fields);
}

void add(Numbers& numbers, const LoadedTable& loaded) {
  const auto& [table, status] = loaded;
  add(numbers, table);
  numbers(status);
}

void add(Numbers& numbers, const AssertionLog& assertions) {
  numbers(assertions.file());
  numbers(assertions.line());
  numbers(assertions.count());
}

}  // namespace

std::uint32_t digest_of(const AppState& state, const Estimator& estimator) {
  // Of the members below these are left out.
  // Given from outside: platform, expected_target, table_is_given, and all of the authority but the key slot.
  // Held by the platform's store, where it has one: stored, resumption.
  // Also about timing faults: events, of which the run has all that are sent, and the windows of faults,
  // whose consequences are in the telemetry. Computed over addresses: constants_crc32.
  const auto& [now_ns, platform, authority, expected_target, events, stored, resumption, counters, tracking,
               faults, banks, assertions, table, loaded_table, faults_seen, estimator_crc32, constants_crc32,
               words_corrected, frames_unused, boot_status, mode, boot_to_report, has_cycle, outage,
               long_task, pose_is_verified, table_is_given] = state;
  gnc::Crc32 crc;
  Numbers numbers(crc);
  numbers(estimator.state_crc32());
  numbers(estimator.model().crc32);
  numbers(now_ns);
  numbers(authority.slot());
  hal::add_to_digest(crc, counters);
  add(numbers, tracking);
  numbers(faults.persisting() & ~hal::kTimingFaults);
  numbers(faults.disabled());
  add(numbers, banks);
  add(numbers, assertions);
  add(numbers, table);
  add(numbers, loaded_table);
  numbers(faults_seen & ~hal::kTimingFaults);
  numbers(estimator_crc32);
  numbers(words_corrected);
  numbers(frames_unused);
  numbers(boot_status);
  numbers(mode);
  for (const bool flag : {boot_to_report, has_cycle, outage, long_task, pose_is_verified}) numbers(flag);
  return crc.value();
}

}  // namespace tumblesight::fsw
