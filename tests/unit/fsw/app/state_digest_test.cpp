// The digest of the application's state, member by member.
// Verifies TS-TLM-020.
#include "fsw/app/state_digest.hpp"

#include "tests/support/app_memory.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

class StateDigest : public AppFixture {
 protected:
  StateDigest() { init_with_model(); }

  // The bytes of a member whose lowest bit does not change the digest.
  template <class Member>
  std::size_t silent_bytes(const Member& member) {
    AppState& state = AppMemory::state(*app);
    const std::uint32_t before = app->state_crc32();
    const std::size_t offset = static_cast<std::size_t>(reinterpret_cast<const std::uint8_t*>(&member) -
                                                        reinterpret_cast<const std::uint8_t*>(&state));
    std::uint8_t* const bytes = reinterpret_cast<std::uint8_t*>(&state) + offset;
    std::size_t silent = 0;
    for (std::size_t i = 0; i < sizeof member; ++i) {
      bytes[i] ^= 1;
      if (app->state_crc32() == before) ++silent;
      bytes[i] ^= 1;
    }
    return silent;
  }
};

TEST_F(StateDigest, CoversEveryByteOfEveryMemberThatTheWallClockAndThePlatformLeaveAlone) {
  const auto& [cycle_ns, platform, authority, expected_target, events, stored, resumption, counters, tracking,
               faults, banks, assertions, table, loaded_table, faults_seen, estimator_crc32, constants_crc32,
               words_corrected, frames_unused, boot_status, mode, boot_to_report, has_cycle, outage,
               long_task, pose_is_verified, table_is_given] = AppMemory::state(*app);
  EXPECT_EQ(silent_bytes(cycle_ns), 0U);
  EXPECT_EQ(silent_bytes(banks.descriptor), 0U);
  EXPECT_EQ(silent_bytes(banks.in_use), 0U);
  EXPECT_EQ(silent_bytes(banks.next_block), 0U);
  EXPECT_EQ(silent_bytes(banks.next_copied), 0U);
  EXPECT_EQ(silent_bytes(banks.missing), 0U);
  EXPECT_EQ(silent_bytes(banks.table_crc32), 0U);
  EXPECT_EQ(silent_bytes(tracking.q_inertial_lrf), 0U);
  EXPECT_EQ(silent_bytes(tracking.has_jumped), 0U);
  EXPECT_EQ(silent_bytes(tracking.has_found_rate), 0U);
  EXPECT_EQ(silent_bytes(tracking.has_chaser_attitude), 0U);
  EXPECT_EQ(silent_bytes(table), 0U);
  EXPECT_EQ(silent_bytes(loaded_table.table), 0U);
  EXPECT_EQ(silent_bytes(loaded_table.status), 0U);
  EXPECT_EQ(silent_bytes(estimator_crc32), 0U);
  EXPECT_EQ(silent_bytes(words_corrected), 0U);
  EXPECT_EQ(silent_bytes(frames_unused), 0U);
  EXPECT_EQ(silent_bytes(boot_status), 0U);
  for (const bool* flag : {&boot_to_report, &has_cycle, &outage, &long_task, &pose_is_verified})
    EXPECT_EQ(silent_bytes(*flag), 0U);
  EXPECT_EQ(silent_bytes(mode), 0U);

  // Left out as a whole.
  EXPECT_EQ(silent_bytes(expected_target), sizeof expected_target);
  EXPECT_EQ(silent_bytes(events), sizeof events);
  EXPECT_EQ(silent_bytes(stored), sizeof stored);
  EXPECT_EQ(silent_bytes(resumption), sizeof resumption);
  EXPECT_EQ(silent_bytes(table_is_given), sizeof table_is_given);
  EXPECT_EQ(silent_bytes(constants_crc32), sizeof constants_crc32);
  EXPECT_EQ(silent_bytes(platform.command_apid), sizeof platform.command_apid);

  // In part: the slot of the authority, what the monitor found, and all but the pending flag of the
  // assertions.
  EXPECT_EQ(silent_bytes(authority), sizeof authority - sizeof authority.slot());
  EXPECT_EQ(silent_bytes(faults), sizeof faults - sizeof faults.persisting() - sizeof faults.disabled());
  EXPECT_EQ(silent_bytes(assertions), sizeof assertions - 3 * sizeof(std::uint32_t));
  EXPECT_EQ(silent_bytes(faults_seen), 0U);
}

TEST_F(StateDigest, CoversTheTelemetryAsTheDigestOfMessagesDoes) {
  hal::Telemetry& counters = AppMemory::state(*app).counters;
  const std::uint32_t before = app->state_crc32();
  counters.model_blocks_repaired ^= 1;  // which an earlier digest left out
  EXPECT_NE(app->state_crc32(), before);
  counters.model_blocks_repaired ^= 1;
  counters.cycle_us ^= 1;
  EXPECT_EQ(app->state_crc32(), before);
}

}  // namespace
}  // namespace tumblesight::fsw
